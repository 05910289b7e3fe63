from score_climate import *; import sys, json
kw=json.load(open(sys.argv[1])); ex=dict(a.split('=') for a in sys.argv[3:]); s=Server(sys.argv[2],2); 
def run(planet,out,res): return s.run(planet,out,resolution_deg=res,**{**{'humidity_exponent':2,'eddy_gradient_k_1000km':3.87},**kw,**ex})
m=run('earth.raw','/tmp/od.bin',4); r=score(m); show(r)
kc,ko,ok=r['_k']; N='- Af Am Aw BWh BWk BSh BSk Csa Csb Csc Cwa Cwb Cwc Cfa Cfb Cfc Dsa Dsb Dsc Dsd Dwa Dwb Dwc Dwd Dfa Dfb Dfc Dfd ET EF'.split()
for cls in (1,2,3,14,15,8,26,27,23,4,6,7,29):
    f=(ko==cls)&ok; t=W[f].sum(); u={N[k]:round(W[f&(kc==k)].sum()/t*100) for k in range(1,31) if (f&(kc==k)).any()}
    print(N[cls],round(t/W[ok].sum()*100,1),dict(sorted(u.items(),key=lambda x:-x[1])[:7]))
np.set_printoptions(linewidth=200,precision=0,suppress=True)
for b in ('SEUS','SECH','SBRA','EAUS','INDI','Congo','Amaz','NWEu'):
    print(b,'P',np.array([box(r['_P'][q],b,ok) for q in range(12)]),'o',np.array([box(Pmon[q],b,ok) for q in range(12)]))
    print('    T',np.array([box(r['_T'][q],b,ok) for q in range(12)]),'o',np.array([box(Tn[q],b,ok) for q in range(12)]))
print(""); (json.dumps({k:float('%.4g'%v) for k,v in kw.items()}))
import matplotlib; matplotlib.use('Agg'); import matplotlib.pyplot as plt
fig,ax=plt.subplots(4,2,figsize=(17,18)); d=r['_d']; LA=(np.asarray(to_obs(m['land'],m['nx'],m['ny']))>.5)
for k,q in enumerate((0,6)):
    for row,(f,v,c) in enumerate(((r['_P'][q],300,'YlGnBu'),(Pmon[q],300,'YlGnBu'),(r['_P'][q]-Pmon[q],200,'BrBG'),(np.where(LA,d[q],(to_obs(m['T']-m['lapse']*m['h'],m['nx'],m['ny'])-Tn)[q]),12,'RdBu_r'))):
        a=ax[row,k]; im=a.imshow(f,origin='lower',extent=[-180,180,-90,90],vmin=0 if row<2 else -v,vmax=v,cmap=c); a.contour(LON,LAT,LA,[.5],colors='k',linewidths=.6); a.set_title(f'{row} month {q}')
plt.tight_layout(); plt.savefig('/tmp/diag.png',dpi=60)
