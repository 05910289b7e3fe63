import sys,json
from score_climate import *
s=Server('./clim2',2)
def go(f,**ex):
    kw=json.load(open(f)); m=s.run('continents.raw','/tmp/g.bin',resolution_deg=5,humidity_exponent=2,eddy_gradient_k_1000km=3.87,**{**kw,**ex}); ny,nx=m['ny'],m['nx']
    lat=(np.arange(ny)+.5)*180/ny-90; land=m['land']>.5; T=m['T'].max(0); r=[]
    for y in (62,72,78,83,88):
        q=land&(abs(abs(lat)-y)<2.6)[:,None]; r.append('%.1f'%T[q].mean())
    e=s.run('earth.raw','/tmp/g.bin',resolution_deg=4,humidity_exponent=2,eddy_gradient_k_1000km=3.87,**{**kw,**ex}); sc=score(e)
    print(f,ex,'warmest month at sea level 62,72,78,83,88:',r,'Trms %.2f warm6070 %.1f gE %.3f/%.3f rjja %.3f'%(sc['Trms'],sc['warm6070'],sc['gE'],sc['ogE'],sc['r_jja']))
go('e1.json',melt_w_m2_k=12,sea_ice_coalbedo=.5)
go('e1.json',melt_w_m2_k=12,sea_ice_coalbedo=.5,snow_coalbedo=.6)
go('e1.json',melt_w_m2_k=14,sea_ice_coalbedo=.5,ice_coalbedo=.4)
