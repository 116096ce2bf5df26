// Shadows of many shapes on a floor and two walls. Twin: scene.xml.
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
camera { orthographic location <5, -7, 6> sky z up 7.2*3/4*y right -7.2*x look_at <-0.2, 0.3, 0.9> }

polygon { 5, <-3, -3, 0>, <3, -3, 0>, <3, 3, 0>, <-3, 3, 0>, <-3, -3, 0> Matt(0.65) }
polygon { 5, <-3, 3, 0>, <3, 3, 0>, <3, 3, 3>, <-3, 3, 3>, <-3, 3, 0> Matt(0.65) }
polygon { 5, <-3, -3, 0>, <-3, 3, 0>, <-3, 3, 3>, <-3, -3, 3>, <-3, -3, 0> Matt(0.65) }
box { <-0.08, -0.08, -0.7>, <0.08, 0.08, 0.7> translate <0.9, 0.2, 0.7> Matt(0.4) }
box { <-0.08, -0.08, -0.7>, <0.08, 0.08, 0.7> translate <0.9, 0.8, 0.7> Matt(0.4) }
box { <-0.08, -0.08, -0.7>, <0.08, 0.08, 0.7> translate <0.9, 1.4, 0.7> Matt(0.4) }
disc { 0, z, 0.5 rotate 35*x translate <-0.6, 1.3, 1.7> Matt(0.4) }
sphere { <-1.2, -0.6, 1.1>, 0.45 Matt(0.4) }
cylinder { <-0.4, -2, 0.2>, <-1.6, -1.7, 0.6>, 0.2 open Matt(0.4) }
mesh {
  triangle { <0.2, 2, 0.6>, <0.2, 2, 1.4>, <-0.4, 2.2, 1.4> }
  triangle { <0.2, 2, 0.6>, <-0.4, 2.2, 1.4>, <-0.4, 2.2, 0.6> }
  triangle { <-0.4, 2.2, 1.8>, <-1.2, 2.4, 1>, <-0.4, 2.2, 0.2> }
  Matt(0.4)
}
Lamp(<2.2, -1.4, 2.6>, 26)
