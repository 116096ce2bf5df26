// Scaled, sheared, mirrored and turned objects, and instances of a group, in flat colours. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 }

// Colours are those of `crates/integrators/src/signature.rs`; a test holds them to it.
#declare Colour1 = rgb <0.210676, 0.773670, 0.579521>;
#declare Colour2 = rgb <0.866014, 0.510505, 0.219281>;
#declare Colour3 = rgb <0.721352, 0.247340, 0.659042>;
#declare Instance0 = rgb <0.682797, 0.629899, 0.613573>;
#declare Instance1 = rgb <0.538135, 0.366734, 0.253334>;
#declare Instance2 = rgb <0.393473, 0.103569, 0.693094>;
#declare Instance3 = rgb <0.248811, 0.640404, 0.332854>;
#macro Flat(Colour)
  texture { pigment { color Colour } finish { ambient 0 diffuse 0 emission 1 } }
#end

#declare Boat = union {
  box { <-0.6, -0.25, -0.15>, <0.6, 0.25, 0.15> }
  cylinder { <0.2, 0, 0.1>, <0.1, 0, 1.2>, 0.1 open }
}

// A right-handed world: the camera's x axis points to the left. 40 degrees are the vertical angle.
#declare Horizontal = 2*degrees(atan2(tan(radians(40/2))*4/3, 1));
camera {
  perspective location <1.5, -8, 5> sky z up y right -4/3*x angle Horizontal look_at <0, 0, 0.5>
}

// 50 degrees, right-handed, about <0.48, 0.8, 0.36>. Matrices of POV-Ray act on row vectors.
sphere {
  0, 1
  scale <1.2, 0.5, 0.8>
  matrix <0.725089344, 0.412945557, -0.551109253,  -0.138606442, 0.871403539, 0.470578501,  0.674561856, -0.264824164, 0.689082335,  0, 0, 0>
  translate <-1.9, -0.4, 0.9>
  Flat(Instance0)
}
box { -1, 1 matrix <0.7, -0.1, 0,  0.2, 0.6, 0.1,  0.4, 0.3, 0.9,  0.2, -1.2, 0.8> Flat(Colour1) }
// Where the world is right-handed, so are the rotations of POV-Ray.
cylinder {
  0, z, 1 open
  scale <0.4, 0.4, 1.6> rotate 65*y translate <-2.6, 1.6, 0.2>
  Flat(Colour2)
}
disc { 0, z, 1 scale <1.5, 0.5, 1> rotate -60*x rotate 35*z translate <0.2, 1.8, 2.2> Flat(Colour3) }
object { Boat rotate 25*z translate <2.2, -0.9, 0.2> Flat(Instance1) }
object { Boat scale <-1.2, 1, 1.6> rotate -15*z translate <2.1, 1, 0.6> Flat(Instance2) }
object { Boat rotate 170*x scale 1.4 translate <-0.6, -2.2, -0.4> Flat(Instance3) }
