// Things of glass by Fresnel's equations among shining walls: no classic materials. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 14 adc_bailout 0 }

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.3, -6, 2.4> sky z up y right -4/3*x angle 44 look_at <0, 0, 0.8> }

#declare Shining = finish { ambient 0 diffuse 0 emission 1 }
#macro Glass()
  texture {
    pigment { color rgb 0 transmit 1 }
    finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  }
  interior { ior 1.5 }
#end

polygon {
  5, <-5, -5, 0>, <0, -5, 0>, <0, 5, 0>, <-5, 5, 0>, <-5, -5, 0>
  texture { pigment { color rgb <0.15, 0.3, 0.5> } finish { Shining } }
}
polygon {
  5, <0, -5, 0>, <5, -5, 0>, <5, 5, 0>, <0, 5, 0>, <0, -5, 0>
  texture { pigment { color rgb <0.6, 0.55, 0.3> } finish { Shining } }
}
polygon {
  5, <-5, 3, 0>, <5, 3, 0>, <5, 3, 3>, <-5, 3, 3>, <-5, 3, 0>
  texture { pigment { color rgb <0.55, 0.25, 0.2> } finish { Shining } }
}
polygon {
  5, <-5, -5, 4>, <5, -5, 4>, <5, 5, 4>, <-5, 5, 4>, <-5, -5, 4>
  texture { pigment { color rgb 0.9 } finish { Shining } }
}
sphere { <-0.9, 0.1, 0.95>, 0.85 Glass() }
box { <-0.5, -0.5, -0.5>, <0.5, 0.5, 0.5> Glass() rotate 25*z translate <1.1, -0.2, 0.55> }
