import sys,netCDF4
from score_climate import *
def load_run(f, relief=None):
    d=netCDF4.Dataset(f); g=lambda n: np.ma.filled(d[n][:].astype(float),np.nan)
    T,P,u,v=[g(n) for n in('temperature_monthly','precipitation_monthly','wind_east_monthly','wind_north_monthly')]
    z=np.ma.filled((netCDF4.Dataset(relief) if relief else d)['elevation'][:].astype(float),0); z=z.reshape(z.shape[-2:])
    if d['lat'][0]>d['lat'][-1]: T,P,u,v=[a[:,::-1] for a in(T,P,u,v)]; z=z[::-1]
    ny,nx=z.shape; return dict(nx=nx,ny=ny,land=(z>=0).astype(float),h=np.maximum(z,0)*0,T=T,P=P,u=u,v=v,lapse=0.)
if __name__=='__main__':
    m=load_run(*sys.argv[1:]); r=score(m); show(r)
