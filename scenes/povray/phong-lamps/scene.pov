// Phong highlights on spheres and a floor under three lamps whose light does not fade; ambient light. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 12 adc_bailout 0 }

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.4, -6.5, 3> sky z up y right -4/3*x angle 46 look_at <0, 0, 0.6> }

#macro Phong(Ambient, Diffuse, Specular, Exponent)
  texture {
    pigment { color rgb Diffuse }
    finish { ambient Ambient diffuse 1 phong Specular phong_size Exponent }
  }
#end

// POV-Ray multiplies ambient light by the pigment.
polygon { 5, <-4, -4, 0>, <4, -4, 0>, <4, 4, 0>, <-4, 4, 0>, <-4, -4, 0> Phong(0.1/0.45, 0.45, 0.15, 12) }
sphere { <-1.2, 0.2, 0.9>, 0.9 Phong(0.08/0.5, 0.5, 0.25, 4) }
sphere { <0.7, -0.6, 0.2>, 0.6 Phong(0.2, <0.6, 0.15, 0.1>, 0.4, 25) }
sphere { <1.3, 1.1, 1.4>, 0.5 Phong(0.2, <0.1, 0.25, 0.6>, 0.6, 150) }
light_source { <2.4, -1.8, 3.6> rgb 0.7 }
light_source { <-3, -2.5, 2.5> rgb 0.4 }
light_source { <0.5, 3, 5> rgb 0.3 }
