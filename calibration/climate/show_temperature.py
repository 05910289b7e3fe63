import sys,json
from score_climate import *
kw=json.load(open(sys.argv[1])); s=Server(sys.argv[2],2)
m=s.run('earth.raw','/tmp/tm.bin',resolution_deg=4,**{**{'humidity_exponent':2,'eddy_gradient_k_1000km':3.87},**kw}); T,land,Tl=prep(m); Ta=to_obs(T,m['nx'],m['ny']); L=land>.5
import matplotlib; matplotlib.use('Agg'); import matplotlib.pyplot as plt
fig,ax=plt.subplots(3,2,figsize=(17,13)); z=lambda f: f-f.mean(1,keepdims=True)
for k,q in enumerate(([0],[6])):
    a,b=Ta[q].mean(0),Tn[q].mean(0)
    for row,f in enumerate((z(a),z(b),a-b)):
        x=ax[row,k]; im=x.contourf(LON,LAT,f,levels=np.arange(-14,15,2),cmap='RdBu_r',extend='both'); x.contour(LON,LAT,L,[.5],colors='k',linewidths=.6); x.set_title(f'{["model zonal anomaly","obs","model-obs"][row]} {q}')
plt.tight_layout(); plt.savefig('/tmp/tmap.png',dpi=55)
