// Mirrors that see each other on a checkered floor, under two lamps. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 12 adc_bailout 0 }

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.3, -6, 2.6> sky z up y right -4/3*x angle 52 look_at <0, 0, 0.9> }

// I/d² in the limit: POV-Ray's 2/(1 + (d/f)²) is 2f²/d² for f far below d.
#declare F = 0.001;
#macro Lamp(Position, Intensity)
  light_source { Position rgb Intensity/(2*F*F) fade_distance F fade_power 2 }
#end
#macro Mirror(Diffuse, Specular, Exponent, Global)
  texture {
    pigment { color rgb Diffuse }
    finish { ambient 0 diffuse 1 phong Specular phong_size Exponent reflection Global }
  }
#end

polygon {
  5, <-5, -5, 0>, <5, -5, 0>, <5, 5, 0>, <-5, 5, 0>, <-5, -5, 0>
  texture {
    pigment { checker color rgb <0.15, 0.3, 0.5> color rgb <0.6, 0.55, 0.3> translate <-5, -5, -0.5> }
    finish { ambient 0 diffuse 1 }
  }
}
sphere { <-1.1, 0.1, 0.9>, 0.9 Mirror(0, 0.3, 60, 0.85) }
sphere { <0.9, -0.4, 0.6>, 0.6 Mirror(0.25, 0.5, 30, 0.4) }
box { <-0.3, -0.3, -0.6>, <0.3, 0.3, 0.6> Mirror(0, 0.3, 60, 0.85) rotate 30*z translate <0.6, 1.2, 0.6> }
polygon {
  5, <-1.6, -1.1, 0>, <1.6, -1.1, 0>, <1.6, 1.1, 0>, <-1.6, 1.1, 0>, <-1.6, -1.1, 0>
  Mirror(0.1, 0, 1, 0.7) rotate 90*x rotate -40*z translate <2.2, 2, 1.1>
}
Lamp(<2, -3, 4>, 14)
Lamp(<-3, -1, 3>, 8)
