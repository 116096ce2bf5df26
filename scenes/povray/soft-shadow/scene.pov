// The soft shadow of an area light that is a grid of five by four lamps. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 12 adc_bailout 0 }

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.4, -6.5, 3> sky z up y right -4/3*x angle 46 look_at <0, 0, 0.6> }

// I/d² in the limit: POV-Ray's 2/(1 + (d/f)²) is 2f²/d² for f far below d.
#declare F = 0.001;
#macro Lamp(Position, Intensity)
  light_source { Position rgb Intensity/(2*F*F) fade_distance F fade_power 2 }
#end
#macro Phong(Diffuse, Specular, Exponent)
  texture { pigment { color rgb Diffuse } finish { ambient 0 diffuse 1 phong Specular phong_size Exponent } }
#end

polygon { 5, <-4, -4, 0>, <4, -4, 0>, <4, 4, 0>, <-4, 4, 0>, <-4, -4, 0> Phong(0.6, 0, 1) }
sphere { <-0.6, 0.2, 1>, 0.6 Phong(<0.6, 0.15, 0.1>, 0.4, 25) }
box { <-0.25, -0.25, -0.8>, <0.25, 0.25, 0.8> Phong(0.5, 0.3, 60) rotate 35*z translate <0.8, -0.5, 0.8> }
#for (I, 0, 4)
  #for (J, 0, 3)
    Lamp(<1.4, -1.2, 3.2> + <0.9, 0, 0>*(I/4 - 0.5) + <0, 0.6, 0.3>*(J/3 - 0.5), 0.45)
  #end
#end
