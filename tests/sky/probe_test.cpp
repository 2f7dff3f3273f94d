#include <gtest/gtest.h>
#include <cstdio>
#include <chrono>
#include <fstream>
#include "core/observer.h"
#include "core/color.h"
#include "core/image_io.h"
#include "core/num.h"
#include "core/sky/sky_model.h"
using namespace obscura;
static double now(){return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();}
TEST(Probe, Numbers) {
    std::printf("sun true %g %g %g lux/W %g\n", sun_above_air_true().x, sun_above_air_true().y, sun_above_air_true().z, lux_per_watt());
    double t0=now(); air_to_space(0,1); double t1=now(); std::printf("table %.3f s\n", t1-t0);
    std::printf("zenith %g %g %g  horizon %g %g %g\n", air_to_space(0,1).molecules, air_to_space(0,1).aerosol, air_to_space(0,1).ozone, air_to_space(0,0).molecules, air_to_space(0,0).aerosol, air_to_space(0,0).ozone);
    double worst[3]={0,0,0};
    for (double h : {0.,.1,.3,.7,1.3,2.2,4.1,7.3,12.,18.,27.,40.,60.}) for (int k=-40;k<=100;++k){ double mu=k<40?k*.004:.16+(k-40)*.014; if(ray_end(h,mu).on_ground) continue; auto a=air_to_space(h,mu), b=air_along(h,mu,0,ray_end(h,mu).distance_km);
      auto e=[&](int i,double x,double y){ if(y>1e-3){ if(std::abs(x/y-1)>worst[i]) {worst[i]=std::abs(x/y-1); }}}; e(0,a.molecules,b.molecules); e(1,a.aerosol,b.aerosol); e(2,a.ozone,b.ozone);} 
    std::printf("table worst %g %g %g\n", worst[0],worst[1],worst[2]);
    Exec one; one.threads=1;
    for (double T : {2.,3.,6.}) {
        ClearAirParams p; p.turbidity=T; p.sun_above_air_w_m2=sun_above_air_true();
        t0=now(); ClearAir air=clear_air(p,one); t1=now();
        for (double el : {90.,60.,30.,10.,5.,2.,0.,-2.,-4.,-6.,-9.,-12.,-15.,-18.}) {
            double a=now(); ClearSky s=clear_sky(air,180,el,one); double b=now();
            auto Y=[&](Vec3f c){return srgb_luminance(to_double(c));};
            double lw=lux_per_watt();
            double sky=Y(s.sky_irradiance_w_m2)*lw, sun=Y(s.sun_irradiance_w_m2)*lw, tot=sky+sun*std::max(0.,s.towards_sun.y);
            Vec3f z=sky_radiance(s,{0,1,0}); Vec3f hs=sky_radiance(s,compass_direction(180,1)), ha=sky_radiance(s,compass_direction(0,1));
            auto cct=[&](Vec3f c){ Vec3d X=xyz_from_srgb(to_double(c)); double S=X.x+X.y+X.z, x=X.x/S,y=X.y/S,n=(x-.3320)/(.1858-y); return 449*n*n*n+3525*n*n+6823.3*n+5520.33;};
            std::printf("T%g el %5g: sky %9.4g lx sun %9.4g tot %9.4g (pub %9.4g) zen %8.4g cd/m2 cct %6.0f hor sun %8.4g anti %8.4g | sun rgb %.3g %.3g %.3g | z %.3g %.3g %.3g hs %.3g %.3g %.3g (%.3f s, air %.3f)\n",T,el,sky,sun,tot,el>=-18?clear_twilight_lux(el):0,Y(z)*lw,cct(z),Y(hs)*lw,Y(ha)*lw,s.sun_irradiance_w_m2.x,s.sun_irradiance_w_m2.y,s.sun_irradiance_w_m2.z,z.x,z.y,z.z,hs.x,hs.y,hs.z,b-a,t1-t0);
        }
    }
}
