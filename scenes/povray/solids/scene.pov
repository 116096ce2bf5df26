// A box, an open cylinder seen from both sides, a disk and a rectangle under a lamp. Twin: scene.xml.
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

// A right-handed world: the camera's x axis points to the left. 38 degrees are the vertical angle.
#declare Horizontal = 2*degrees(atan2(tan(radians(38/2))*4/3, 1));
camera {
  perspective location <-4, -5, 4> sky z up y right -4/3*x angle Horizontal look_at <0, 0, 0.5>
}

polygon { 5, <-3.5, -3.5, 0>, <3.5, -3.5, 0>, <3.5, 3.5, 0>, <-3.5, 3.5, 0>, <-3.5, -3.5, 0> Matt(0.5) }
// Where the world is right-handed, so are the rotations of POV-Ray.
box { <-0.7, -0.5, -0.9>, <0.7, 0.5, 0.9> rotate -25*z translate <-0.9, 0.6, 0.9> Matt(0.7) }
cylinder { <0.6, -0.9, 0.5>, <-0.3, -1.7, 0.7>, 0.45 open Matt(0.7) }
disc { 0, z, 0.8 rotate 50*x rotate -30*z translate <1.5, 0.9, 1.2> Matt(0.7) }
polygon {
  5, <-0.5, -0.9, 0>, <0.5, -0.9, 0>, <0.5, 0.9, 0>, <-0.5, 0.9, 0>, <-0.5, -0.9, 0>
  rotate -70*y translate <1.9, -1, 0.8>
  Matt(0.7)
}
Lamp(<-1.5, -2, 4>, 36)
