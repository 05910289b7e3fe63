import json,re,sys
kw=json.load(open(sys.argv[1])); A='libgeo/'; P=open(A+'src/stages/climate/climate_parameters.cpp').read()
files={'e':'energy_balance','c':'circulation','m':'moisture','soil':'soil_moisture','seasonal':'seasonal_climate'}
fmt=lambda v: '%.3g'%v
W=A+'include/geo/kernels/climate/stationary_wave.hpp'; ws=open(W).read()
g=lambda k: fmt(kw[k])
ws=re.sub(r"WaveMode internal\{[^}]*\};","WaveMode internal{%s, %s, %s, %s};"%tuple(map(g,('wave_speed_m_s','wave_momentum_damping_d','wave_thermal_damping_d','wave_wind_share'))),ws)
ws=re.sub(r"double heating_m4_s3_w = [^;]*;","double heating_m4_s3_w = %s;"%g('wave_heating_m4_s3_w'),ws); ws=re.sub(r"double mountain_share = [^;]*;","double mountain_share = %s;"%g('mountain_share'),ws); open(W,'w').write(ws)
for k,v in kw.items():
    if k.startswith('wave_') or k=='mountain_share' or k=='eddy_gradient_k_1000km': continue
    m=re.search(r'real\("climate\.%s", (?:(\w+)\.)?(\w+),'%k,P)
    if not m: print('none',k); continue
    o,mem=m.groups(); f=A+('include/geo/kernels/climate/%s.hpp'%files[o] if o else 'include/geo/stages/climate/climate.hpp')
    s=open(f).read(); s,n=re.subn(r"(double %s =\s*)[^;]*;"%mem,lambda q:q.group(1)+fmt(v)+';',s); 
    if n!=1: print('count',k,n)
    open(f,'w').write(s)
