// Objects in flat colours of their own under parallel projection. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 }

// Colours are those of `crates/integrators/src/signature.rs`; a test holds them to it.
#declare Colour0 = rgb <0.355338, 0.236835, 0.139760>;
#declare Colour1 = rgb <0.210676, 0.773670, 0.579521>;
#declare Colour2 = rgb <0.866014, 0.510505, 0.219281>;
#declare Colour3 = rgb <0.721352, 0.247340, 0.659042>;
#declare Colour4 = rgb <0.576690, 0.784174, 0.298802>;
#declare Colour5 = rgb <0.432028, 0.521009, 0.738562>;
#macro Flat(Colour)
  texture { pigment { color Colour } finish { ambient 0 diffuse 0 emission 1 } }
#end

// A right-handed world: the camera's x axis points to the left.
camera { orthographic location <6, 4, 5> sky <0, 0.3, 1> up 4.8*160/120*y right -4.8*x look_at <0.1, -0.2, 0.3> }

// Where the world is right-handed, so are the rotations of POV-Ray.
polygon {
  5, <-2.2, -1.4, 0>, <2.2, -1.4, 0>, <2.2, 1.4, 0>, <-2.2, 1.4, 0>, <-2.2, -1.4, 0>
  rotate 90*x rotate -20*z translate <-1, -1.6, 0.2>
  Flat(Colour0)
}
mesh {
  triangle { <-0.7, -0.9, 0.5>, <0.9, -0.6, 0.4>, <0.1, 0, 2.2> }
  triangle { <0.9, -0.6, 0.4>, <0.7, 0.7, 0.6>, <0.1, 0, 2.2> }
  triangle { <0.7, 0.7, 0.6>, <-0.8, 0.6, 0.5>, <0.1, 0, 2.2> }
  triangle { <-0.8, 0.6, 0.5>, <-0.7, -0.9, 0.5>, <0.1, 0, 2.2> }
  Flat(Colour1)
}
sphere { <0.2, 0.9, -0.6>, 0.7 Flat(Colour2) }
sphere { <0.8, 0.2, -0.9>, 0.6 Flat(Colour3) }
cylinder { <-0.9, 1.3, 0.5>, <-1.2, 1.8, 0.4>, 0.8 open Flat(Colour4) }
// 40 degrees about <0.6, 0.8, 0>: that axis turned to x, and back.
#declare Axis = degrees(atan2(0.8, 0.6));
box { -1, 1 rotate -Axis*z rotate 40*x rotate Axis*z translate <0.4, 0.3, -2.9> Flat(Colour5) }
