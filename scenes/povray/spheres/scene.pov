// Matt spheres on a floor under a lamp: terminators, cast shadows, a sphere that the floor cuts. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 }

// I/d² in the limit: POV-Ray's 2/(1 + (d/f)²) is 2f²/d² for f far below d; Lambert's 1/π.
#declare F = 0.001;
#macro Lamp(Position, Intensity)
  light_source { Position rgb Intensity/(2*F*F*pi) fade_distance F fade_power 2 }
#end
#macro Matt(Reflectance)
  texture { pigment { color rgb Reflectance } finish { ambient 0 diffuse 1 } }
#end

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.5, -6.5, 3> sky z up y right -4/3*x angle 46 look_at <0, 0, 0.6> }

polygon { 5, <-4, -4, 0>, <4, -4, 0>, <4, 4, 0>, <-4, 4, 0>, <-4, -4, 0> Matt(0.6) }
sphere { <-1.2, 0.2, 0.9>, 0.9 Matt(0.8) }
sphere { <0.7, -0.6, 0.2>, 0.6 Matt(<0.7, 0.2, 0.15>) }
sphere { <1.3, 1.1, 1.4>, 0.5 Matt(<0.15, 0.3, 0.6>) }
Lamp(<2.4, -1.8, 3.6>, 30)
