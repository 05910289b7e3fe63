"""Scores climates of the server against observations."""
import numpy as np, netCDF4, subprocess, os
D=os.environ['CLIMATE_OBSERVATIONS']+'/'  # monthly NCEP temperature, CMAP precipitation, ERA-Interim winds
def nc(f,v): return np.ma.filled(netCDF4.Dataset(D+f)[v][:].astype(float),np.nan)
NT='ncep_air_temperature_2p5deg_monthly.nc'; CP='cmap_precipitation_2p5deg_monthly.nc'; ER='eraint_winds_1p5deg_jan_jul.nc'
To=nc(NT,'t'); Tlat=nc(NT,'lat'); Po=nc(CP,'p'); Plat=nc(CP,'lat'); Plon=nc(CP,'lon')
To=np.where(To<-900,np.nan,To); Po=np.where(Po<-900,np.nan,Po)
# T onto CMAP nodes (offset half a cell): mean of the four around
Tn=0.5*(To[:,:-1]+To[:,1:]); Tn=0.5*(Tn+np.roll(Tn,-1,2))
days=np.array([31,28.25,31,30,31,30,31,31,30,31,30,31])
Pmon=Po*(365.25/12)
LAT=Plat[:,None]*np.ones(144); LON=np.ones((72,1))*Plon
W=np.cos(np.radians(LAT))
def overlap(n_mod, edges_obs, lo, hi, periodic):
    em=np.linspace(lo,hi,n_mod+1); M=np.zeros((len(edges_obs)-1,n_mod))
    for k in range(len(edges_obs)-1):
        a,b=edges_obs[k],edges_obs[k+1]
        for s in ((-360,0,360) if periodic else (0,)):
            M[k]+=np.clip(np.minimum(b+s,em[1:])-np.maximum(a+s,em[:-1]),0,None)
    return M/M.sum(1,keepdims=True)
maps={}
def to_obs(f, nx, ny, ol=None):
    key=(nx,ny)
    if key not in maps:
        eo=np.linspace(-90,90,73); maps[key]=(overlap(ny,eo,-90,90,False), overlap(nx,np.linspace(-180,180,145),-180,180,True))
    a,b=maps[key]; return np.einsum('ij,...jk,lk->...il',a,f,b,optimize=True)
def load(out):
    b=open(out,'rb').read(); nx,ny=np.frombuffer(b[:8],np.int32); lapse=np.frombuffer(b[8:12],np.float32)[0]
    f=np.frombuffer(b[12:],np.float32).reshape(-1,ny,nx).astype(float)
    return dict(nx=int(nx),ny=int(ny),land=f[0],h=f[1],T=f[2:14],P=f[14:26],u=f[26:38],v=f[38:50],lapse=lapse)
def koppen(T,P,south):
    warm,cold,mean=T.max(0),T.min(0),T.mean(0); ann=P.sum(0); dry=P.min(0); m10=(T>=10).sum(0)
    A=np.array([3,4,5,6,7,8]); B=np.array([9,10,11,0,1,2]); s=south
    def half(fn): a,b=fn(P[A]),fn(P[B]); return np.where(s,b,a),np.where(s,a,b)
    sum_,_=half(lambda x:x.sum(0)); sd,wd=half(lambda x:x.min(0)); sw,ww=half(lambda x:x.max(0))
    sh=np.where(ann>0,sum_/np.maximum(ann,1e-9),.5)
    th=np.where(sh>.7,10*(2*mean+28),np.where(sh<.3,20*mean,10*(2*mean+14)))
    ds=(sd<40)&(sd<ww/3); dw=wd<sw/10; both=ds&dw
    ds=np.where(both,sum_<.5*ann,ds); dw=np.where(both,~ds.astype(bool),dw)
    let=np.where(warm>=22,0,np.where(m10>=4,1,np.where(cold<-38,3,2)))
    c=np.where(cold>0, np.where(ds,8,np.where(dw,11,14))+np.minimum(let,2), np.where(ds,17,np.where(dw,21,25))+let)
    c=np.where(warm<=10,np.where(warm>0,29,30),c)
    c=np.where((cold>=18),np.where(dry>=60,1,np.where(dry>=100-ann/25,2,3)),c)
    hot=mean>=18; c=np.where(ann<th,np.where(ann<.5*th,np.where(hot,4,5),np.where(hot,6,7)),c)
    return c
def group(c): return np.where(c<=3,0,np.where(c<=7,1,np.where(c<=16,2,np.where(c<=28,3,4))))
def wcorr(a,b,w):
    m=np.isfinite(a)&np.isfinite(b); a,b,w=a[m],b[m],w[m]; w=w/w.sum(); a=a-(a*w).sum(); b=b-(b*w).sum()
    return (a*b*w).sum()/np.sqrt((a*a*w).sum()*(b*b*w).sum())
def latshare(P,w,lat):  # P 2d, w weights 2d (0 excluded); share of variance explained by lat
    m=w>0; tot=(w*P).sum()/w.sum(); var=(w*(P-tot)**2).sum(); num=0
    for j in range(P.shape[0]):
        if w[j].sum()>0: mu=(w[j]*P[j]).sum()/w[j].sum(); num+=w[j].sum()*(mu-tot)**2
    return num/var
BOX=dict(SEUS=(26,37,-95,-78),SECH=(22,34,105,121),SBRA=(-34,-22,-60,-45),EAUS=(-37,-18,145,154),SEAF=(-34,-20,26,36),
 INDI=(10,28,72,88),Sahara=(18,30,-10,30),Arab=(18,30,40,55),Ataca=(-28,-18,-72,-68),Namib=(-28,-18,12,16),CAus=(-30,-20,125,138),Gobi=(39,45,90,108),
 Congo=(-5,5,12,28),Amaz=(-10,2,-72,-52),Sahel=(11,15,-12,32),Indon=(-5,5,98,120),NWEu=(45,56,-5,15),WSib=(54,64,60,90),NWus=(42,52,-125,-118))
Tobs_season=None
def box(f,b,mask):
    s,n,w,e=BOX[b]; m=(LAT>=s)&(LAT<=n)&(LON>=w)&(LON<=e)&mask
    return (f*W)[...,m].sum(-1)/W[m].sum()
landf=None
def prep(m):
    T=m['T']-m['lapse']*m['h']*1.0; land=to_obs(m['land'],m['nx'],m['ny'])
    # land-only temperature: weight by land
    lw=np.maximum(m['land'],1e-6); Tl=to_obs(T*lw,m['nx'],m['ny'])/to_obs(lw,m['nx'],m['ny'])
    return T,land,Tl
ew=None
def winds(m):
    global ew
    if ew is None:
        la=nc(ER,'lat'); lo=nc(ER,'lon'); ew=(la,lo,{k:nc(ER,k) for k in('u850_jan','v850_jan','u850_jul','v850_jul')})
    la,lo,f=ew; from scipy.ndimage import map_coordinates
    res={}
    ny,nx=m['ny'],m['nx']; rr=(la+90)/(180/ny)-.5; cc=((lo+180)%360)/(360/nx)-.5
    RR,CC=np.meshgrid(rr,cc,indexing='ij')
    for k,v in f.items():
        mon=0 if 'jan' in k else 6; mod=map_coordinates(m[k[0]][mon],[RR,CC],order=1,mode='grid-wrap')
        a=mod-mod.mean(1,keepdims=True); b=v-v.mean(1,keepdims=True)
        for h,(s,n) in dict(N=(5,40),S=(-40,-5)).items():
            q=(la>=s)&(la<=n); w=np.cos(np.radians(la[q]))[:,None]*np.ones(len(lo)); res[k[0]+k[5:8]+h]=wcorr(a[q],b[q],w)
    return res
def score(m):
    r={}; T,land,Tl=prep(m); L=(land>.5)&np.isfinite(Po).all(0); P=to_obs(m['P'],m['nx'],m['ny'])
    ann=P.sum(0); oann=Pmon.sum(0); w=W*L; ok=L
    r['r_ann']=wcorr(ann[ok],oann[ok],W[ok]); z=ok&(abs(LAT)>=20)&(abs(LAT)<=40); r['r_2040']=wcorr(ann[z],oann[z],W[z])
    jja,djf=[5,6,7],[11,0,1]
    r['r_jja']=wcorr(P[jja].sum(0)[ok],Pmon[jja].sum(0)[ok],W[ok]); r['r_djf']=wcorr(P[djf].sum(0)[ok],Pmon[djf].sum(0)[ok],W[ok])
    sea=(land<=.5)&np.isfinite(oann)&(abs(LAT)<60); r['r_sea']=wcorr(ann[sea],oann[sea],W[sea])
    for b in BOX: r['o'+b]=box(oann,b,L); r[b]=box(ann,b,L)
    j=[5,6,7,8]; r['IndJJAS']=box(P[j].sum(0),'INDI',L)/122; r['IndShare']=box(P[j].sum(0),'INDI',L)/max(r['INDI'],1e-9)
    in65=(abs(LAT)<65)&np.isfinite(oann); r['lat_all']=latshare(ann,W*in65,LAT); r['olat_all']=latshare(np.nan_to_num(oann),W*in65,LAT)
    r['lat_land']=latshare(ann,W*(in65&L),LAT); r['olat_land']=latshare(np.nan_to_num(oann),W*(in65&L),LAT)
    d=Tl-Tn; dl=d[:,L]; r['Trms']=np.sqrt((dl**2*W[L]).sum()/(12*W[L].sum()))
    for k,q in dict(jan=0,jul=6).items(): r['Trms_'+k]=np.sqrt((d[q][L]**2*W[L]).sum()/W[L].sum())
    na=L&(LAT>-60); r['Tbias']=(d.mean(0)*W)[na].sum()/W[na].sum()
    q=L&(LAT>=60)&(LAT<=70); r['warm6070']=((Tl.max(0)*W)[q].sum())/W[q].sum(); r['owarm6070']=((Tn.max(0)*W)[q].sum())/W[q].sum()
    rng=Tl.max(0)-Tl.min(0); org=Tn.max(0)-Tn.min(0)
    for y in(35,55): q=L&(abs(LAT-y)<2.6); r[f'rng{y}']=(rng*W)[q].sum()/W[q].sum(); r[f'orng{y}']=(org*W)[q].sum()/W[q].sum()
    ok2=L&(LAT>-60); kc=koppen(Tl,P,LAT<0); ko=koppen(Tn,np.nan_to_num(Pmon),LAT<0); ww=W[ok2]/W[ok2].sum()
    r['groups']=((group(kc)==group(ko))[ok2]*ww).sum(); r['classes']=((kc==ko)[ok2]*ww).sum()
    f=(ko==14)&ok2; r['Cfa']=(((kc==14)&f)*W).sum()/(f*W).sum()
    for g,n in enumerate('ABCDE'): r['g'+n]=((group(kc)==g)[ok2]*ww).sum(); r['og'+n]=((group(ko)==g)[ok2]*ww).sum()
    zp=np.array([(ann[i]).mean() for i in range(72)]); zo=np.array([np.nanmean(oann[i]) if np.isfinite(oann[i]).any() else np.nan for i in range(72)]); q=np.isfinite(zo)
    # 10-degree bands
    wb=np.cos(np.radians(Plat)); bands=[]; 
    for s in range(-90,90,10):
        i=(Plat>s)&(Plat<s+10)&q; bands.append(((zp[i]*wb[i]).sum()/wb[i].sum() if i.any() else np.nan,(zo[i]*wb[i]).sum()/wb[i].sum() if i.any() else np.nan,wb[i].sum()))
    bd=np.array(bands); g=np.isfinite(bd[:,0]); r['zonrms']=np.sqrt((((bd[g,0]-bd[g,1])**2*bd[g,2]).sum()/bd[g,2].sum()))/((bd[g,1]*bd[g,2]).sum()/bd[g,2].sum())
    r['landmm']=(ann*w).sum()/w.sum(); r['olandmm']=(np.nan_to_num(oann)*w).sum()/w.sum()
    r.update(winds(m)); r['_k']=(kc,ko,ok2); r['_d']=d; r['_P']=P; r['_T']=Tl
    return r
class Server:
    def __init__(s,exe='./clim',threads=1):
        s.p=subprocess.Popen([exe],stdin=subprocess.PIPE,stdout=subprocess.PIPE,text=True,env=dict(os.environ,OMP_NUM_THREADS=str(threads)))
    def run(s,planet,out,**kw):
        s.p.stdin.write(' '.join([planet,out]+[f'{k}={v}' for k,v in kw.items()])+'\n'); s.p.stdin.flush(); a=s.p.stdout.readline().strip()
        if a!='ok': raise RuntimeError(a)
        return load(out)
def show(r):
    print(' '.join(f'{k}={v:.3g}' for k,v in r.items() if not k.startswith('_') and not (k.startswith('o') and k[1:] in BOX) and k not in BOX))
    print(' '.join(f'{b}={r[b]:.0f}/{r["o"+b]:.0f}' for b in BOX))
