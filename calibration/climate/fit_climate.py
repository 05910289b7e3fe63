"""Levenberg-Marquardt fit of the constants of the climate: fit_climate.py RESOLUTION STEPS START.json OUT.json

Residuals are monthly temperature and the roots of monthly precipitation on land and at sea, winds
that vary along parallels, boxes, zonal means; derivatives are differences."""
from score_climate import *; import sys, json, time
from concurrent.futures import ThreadPoolExecutor
RES=float(sys.argv[1]) ; ITERS=int(sys.argv[2]); START=sys.argv[3] if len(sys.argv)>3 else None; OUT=sys.argv[4]
# name: (start, lo, hi, sigma-step relative or absolute, prior sd in the same unit as scale)
P0={ 'outgoing_w_m2':(198,190,215,4,0),'outgoing_slope_w_m2_k':(2.1,1.8,2.4,.15,0),'diffusivity_w_m2_k':(.6,.3,1.0,.06,0),'moist_transport':(1.0,.3,1.5,.2,0),
'advected_heat_j_m2_k':(5.3e6,2e6,1e7,5e5,0),'heat_wind_share':(.1,0,1,.03,0),'heat_wave_share':(.28,0,1,.05,0),'coalbedo':(.682,.62,.72,.01,0),'coalbedo_p2':(-.16,-.25,-.05,.02,0),
'snow_coalbedo':(.6,.4,.65,.04,0),'snow_temperature_c':(-5,-10,0,1,0),'ice_coalbedo':(.38,.34,.5,.03,0),'sea_ice_coalbedo':(.6,.35,.75,.05,0),'ice_temperature_c':(-3,-9,-1,.7,0),
'land_heat_capacity_w_yr_m2_k':(.085,.05,.3,.015,0),'ocean_heat_capacity_w_yr_m2_k':(7.3,3,14,1,0),'ice_heat_capacity_w_yr_m2_k':(1.16,.3,4,.2,0),'melt_w_m2_k':(12,2,20,2,0),
'gyre_heat_w_m2':(25,5,60,4,0),'gyre_reach_km':(862,300,2500,120,0),'subpolar_heat_w_m2':(30,0,90,6,0),'subpolar_reach_km':(2000,500,5000,300,0),'upwelling_w_m2':(60,0,150,12,0),'upwelling_reach_km':(6000,1500,9000,800,0),'dry_warming_k_m2_w':(.049,0,.12,.008,0),'dry_warming_from_w_m2':(263,150,330,20,0),
'heat_blocking_height_m':(2000,700,8000,400,0),'lapse_k_m':(.0058,.005,.0065,.0002,0),
'drag_ocean_s':(3.6e-5,1e-5,1e-4,5e-6,0),'drag_land_s':(2.5e-5,1e-5,1e-4,5e-6,0),'subtropical_high_hpa':(6,2.5,14,.8,0),'subpolar_low_hpa':(8,2.5,25,1.5,0),'polar_high_hpa':(10.8,1,20,1.5,0),'thermal_low_hpa_k':(1.5,.2,2.5,.15,0),'cold_high_share':(.7,.1,1.2,.1,0),
'displacement_decay':(2.5,1,5,.3,0),'eddy_exponent':(1.5,1,3.5,.2,0),'itcz_share':(.8,.2,1.5,.06,0),'itcz_locality':(.65,0,1,.08,0),
'wave_speed_m_s':(90,40,120,6,0),'wave_momentum_damping_d':(1.31,.5,6,.15,0),'wave_thermal_damping_d':(40,5,60,6,0),'wave_wind_share':(.08,0,.6,.04,0),'wave_heating_m4_s3_w':(3.5e-4,5e-5,8e-4,4e-5,0),'mountain_share':(.043,0,.3,.02,0),'sensible_w_m2_k':(6.6,1,20,.8,0),
'rain_time_d':(.9,.3,6,.1,0),'evaporation_velocity_1_d':(.24,.05,1,.03,0),'evaporating_share':(.85,.4,1.1,.06,0),'base_diffusivity_m2_s':(3.5e6,5e5,8e6,4e5,0),'eddy_diffusivity_m2_s':(1.8e6,2e5,8e6,3e5,0),
'ascent_latitude_deg':(45,15,85,4,0),
'eddy_rain':(1.5,0,12,.3,0),'eddy_gradient_k_1000km':(3.87,3.87,3.87,0,0),'eddy_locality':(.3,0,1,.08,0),'ascent_time_d':(5,.5,20,.6,0),'descent_time_d':(.5,0,8,.3,0),'ascent_smoothing_km':(508,200,1200,50,0),'convection_1_k':(.036,0,.15,.006,0),'convection_latitude_deg':(27,10,60,3,0),
'soil_capacity_mm':(200,100,600,40,0),'soil_stressed_share':(.42,.1,1,.06,0),'blocking_height_m':(3500,800,8000,500,0),'lift_height_m':(1450,500,4000,150,0),
}
names=[k for k in P0 if P0[k][3]>0]
lo=np.array([P0[k][1] for k in names]); hi=np.array([P0[k][2] for k in names]); sc_=np.array([P0[k][3] for k in names])
x0=np.array([P0[k][0] for k in names],float)
if START: 
    st=json.load(open(START)); x0=np.array([st.get(k,a) for k,a in zip(names,x0)])
prior=np.array([P0[k][0] for k in names],float); prior_sd=4*sc_
N=int(os.environ.get('NSRV','2')); servers=[Server(os.environ.get('EXE','./clim'),1) for _ in range(N)]
from queue import Queue
free=Queue(); [free.put(i) for i in range(N)]
def fixed(): return {'humidity_exponent':int(os.environ.get('HEXP','2')),'resolution_deg':RES,'eddy_gradient_k_1000km':3.87}
def res(x):
    i=free.get()
    try:
        out=f'/tmp/lm{os.getpid()}_{i}.bin'; keys=dict(zip(names,x))
        m=servers[i].run('earth.raw',out,**fixed(),**keys)
        others=[other(p,servers[i].run(p+'.raw',out,**{**fixed(),'resolution_deg':OTHER_RES},**keys)) for p in OTHERS]
    finally: free.put(i)
    T,land,Tl=prep(m); ok=np.isfinite(Po).all(0); L=(land>.5)&ok; P=to_obs(m['P'],m['nx'],m['ny']); Ta=to_obs(T,m['nx'],m['ny'])
    LL=L&(LAT>-60); S=(land<=.5)&ok&(abs(LAT)<65); wl=np.sqrt(W[LL]/W[LL].sum()); ws=np.sqrt(W[S]/W[S].sum()); out=[]
    d=(Tl-Tn)[:,LL]*wl/np.sqrt(12)/3.5; out.append(d.ravel())                 # land T by month, in units of 3.5 K
    SA=(land<=.5)&np.isfinite(Tn).all(0)&(abs(LAT)<84); wa=np.sqrt(W[SA]/W[SA].sum()); ds=(Ta-Tn)[:,SA]*wa/np.sqrt(12)/3.5*.9; out.append(ds.ravel())
    f=lambda p:np.sqrt(np.maximum(p,0)+4)
    out.append(((f(P)-f(Pmon))[:,LL]*wl/np.sqrt(12)/3.2).ravel())             # land rain by month
    out.append(((f(P)-f(Pmon))[:,S]*ws/np.sqrt(12)/3.2*.45).ravel())
    a,o=P.sum(0),Pmon.sum(0); g=lambda p:np.sqrt(np.maximum(p,0)+50)
    out.append(((g(a)-g(o))[LL]*wl/8*1.0).ravel())
    for q in ([5,6,7],[11,0,1]): out.append(((g(P[q].sum(0))-g(Pmon[q].sum(0)))[LL]*wl/5*.7).ravel())                               # land rain of the year
    ex=[]
    sx=[]
    for b,t in dict(SEUS=.3,SECH=.3,SBRA=.3,EAUS=.3,SEAF=.3,INDI=.3,Congo=.3,Amaz=.3,Sahel=.3,Indon=.3,NWEu=.3).items():
        q=box(o,b,L); sx.append(np.log((box(a,b,L)+30)/(q+30))/t*(.5 if b=='SBRA' else .25))
    for b,t in dict(Sahara=100,Arab=100,Ataca=100,Namib=100,CAus=100,Gobi=100).items(): sx.append(max(0,box(a,b,L)-190)/t*.7)
    q=L&(LAT>=60)&(LAT<=70); sx.append(((Tl.max(0)-Tn.max(0))*W)[q].sum()/W[q].sum()/1.5*.4)
    for y in(35,55): q=L&(abs(LAT-y)<2.6); rg=lambda t:((t.max(0)-t.min(0))*W)[q].sum()/W[q].sum(); sx.append((rg(Tl)-rg(Tn))/2*.4)
    zm=lambda p:np.array([np.nanmean(p[i:i+4]) for i in range(8,64,4)]); sx.append((zm(a)-zm(o))/300*.25)
    Tz=Ta.mean(0).mean(1); To_=Tn.mean(0).mean(1); zb=lambda p:np.array([(p[i:i+4]*W[i:i+4,0]).sum()/W[i:i+4,0].sum() for i in range(0,72,4)])
    sx.append((zb(Tz)-zb(To_))/2*.3)
    for q in ((LAT<-66)&(land>.5),(LAT>64)&(LAT<81)&(LON>-50)&(LON<-25)&(land>.5)): sx.append(((Tl.max(0)-Tn.max(0))*W)[q].sum()/W[q].sum()/3*.3)
    in65=ok&(abs(LAT)<65); lay=latshare(a,W*in65,LAT); sx.append(max(0,lay-.40)/.1*.6)
    u=winds2(m); out.append(u)
    import score_climate as sc; la,lo_,F=sc.ew; la2=(np.arange(m['ny'])+.5)*180/m['ny']-90
    for k in ('u850_jan','u850_jul'):
        mod=m['u'][0 if 'jan' in k else 6].mean(1); yy=np.array([-55,-50,-45,-40,-35,-30,-25,-20,-15,-10,10,15,20,25,30,35,40,45,50,55]); b=np.interp(yy,la,F[k].mean(1))
        sx.append((np.interp(yy,la2,mod)-.7*b)/5*.15)
    out+=others; out.append(np.hstack(sx)); out.append((x-prior)/prior_sd*.08)
    return np.hstack(out), m
OTHERS=[p for p in os.environ.get('OTHERS','continents,seed52').split(',') if p]; OTHER_RES=4
def other(planet,m):
    # What other planets must have: rain on equatorial land, no planet of ice, a mean temperature like the Earth's.
    ny=m['ny']; lat=(np.arange(ny)+.5)*180/ny-90; w=np.cos(np.radians(lat))[:,None]*np.ones((ny,m['nx'])); land=m['land']>.5
    T=m['T']-m['lapse']*m['h']; a=m['P'].sum(0); q=land&(abs(lat)<8)[:,None]; r=[]
    if q.any(): r.append(max(0,1300-(a*w)[q].sum()/w[q].sum())/300*.4)
    E=((T.max(0)<10)*w)[land].sum()/w[land].sum(); r.append(max(0,E-.16)/.05*.35)
    pol=land&(abs(lat)>74)[:,None]; r.append(max(0,(m['T'].max(0)*w)[pol].sum()/w[pol].sum()-6)/2*.35 if planet=='continents' else 0.)
    g=(T.mean(0)*w).sum()/w.sum(); r.append((max(0,g-16)+min(0,g-12.5))/1.5*.35)
    r.append(max(0,latshare(a,w*(abs(lat)<65)[:,None],lat)-.42)/.1*.4)
    other.seen=getattr(other,'seen',{}); other.seen[planet]=((a*w)[q].sum()/w[q].sum() if q.any() else 0,E,g)
    return np.array(r)
def winds2(m):
    winds(m); import score_climate as sc; la,lo_,f=sc.ew; from scipy.ndimage import map_coordinates
    ny,nx=m['ny'],m['nx']; q=(abs(la)>=5)&(abs(la)<=40); rr=(la[q]+90)/(180/ny)-.5; cc=((lo_+180)%360)/(360/nx)-.5
    RR,CC=np.meshgrid(rr[::2],cc[::3],indexing='ij'); w=np.sqrt(np.cos(np.radians(la[q][::2])))[:,None]; o=[]
    for k,v in f.items():
        mon=0 if 'jan' in k else 6; a=map_coordinates(m[k[0]][mon],[RR,CC],order=1,mode='grid-wrap'); b=v[q][::2,::3]
        a=a-a.mean(1,keepdims=True); b=b-b.mean(1,keepdims=True); s=np.sqrt((b*b*w*w).mean())
        o.append(((a-b)*w/s/np.sqrt(a.size)*.35).ravel())
    return np.hstack(o)
def main():
    x=np.clip(x0,lo,hi); lam=.3; r,m=res(x); c=(r@r); print('start',c,flush=True); show(score(m))
    for it in range(ITERS):
        t=time.time()
        def one(k):
            s=sc_[k]*.5; s=s if x[k]+s<=hi[k] else -s; y=x.copy(); y[k]+=s
            try: return (res(y)[0]-r)/s*sc_[k]
            except Exception as e: print('grad',names[k],e); return np.zeros_like(r)
        with ThreadPoolExecutor(N) as ex: J=np.array(list(ex.map(one,range(len(x))))).T
        A=J.T@J; g=J.T@r; done=False
        for tr in range(3):
            cand=[]
            lams=[lam*10**e for e in ((-1,0) if tr==0 else (.7*tr+.3, .7*tr+.8))]
            def step(l):
                free_=np.ones(len(x),bool)
                for _ in range(6):
                    dx=np.zeros(len(x)); i=np.where(free_)[0]; dx[i]=-np.linalg.solve(A[np.ix_(i,i)]+l*np.diag(np.diag(A)[i]+.02*np.diag(A).mean()),g[i])
                    dx=np.clip(dx,-4,4); y=x+dx*sc_; bad=((y<lo)|(y>hi))&free_&((x<=lo+1e-9*sc_)|(x>=hi-1e-9*sc_))
                    if not bad.any(): break
                    free_&=~bad
                y=np.clip(x+dx*sc_,lo,hi)
                try: rr,mm=res(y); return rr@rr,y,rr,mm,l
                except Exception as e: return (1e9,)
            with ThreadPoolExecutor(N) as ex: cand=list(ex.map(step,lams))
            b=min(cand,key=lambda q:q[0])
            if b[0]<c: c,x,r,m,lam=b; lam=max(lam,1e-3); done=True; break
        print(it,round(c,4),getattr(other,'seen',''),'lam',lam,round(time.time()-t),'s',flush=True); json.dump(dict(zip(names,x)),open(OUT,'w'))
        if it%3==2 or it==ITERS-1: show(score(m)); sys.stdout.flush()
        if not done: lam*=10
        if lam>300: break
    show(score(m)); print({k:float('%.4g'%v) for k,v in zip(names,x)})
if __name__=='__main__': main()
