// Seven objects in flat colours of their own, seen in perspective. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 }

// Colours are those of `crates/integrators/src/signature.rs`; a test holds them to it.
#declare Colour0 = rgb <0.355338, 0.236835, 0.139760>;
#declare Colour1 = rgb <0.210676, 0.773670, 0.579521>;
#declare Colour2 = rgb <0.866014, 0.510505, 0.219281>;
#declare Colour3 = rgb <0.721352, 0.247340, 0.659042>;
#declare Colour4 = rgb <0.576690, 0.784174, 0.298802>;
#declare Colour5 = rgb <0.432028, 0.521009, 0.738562>;
#declare Colour6 = rgb <0.287366, 0.257844, 0.378323>;
#macro Flat(Colour)
  texture { pigment { color Colour } finish { ambient 0 diffuse 0 emission 1 } }
#end

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <5, -6, 4.5> sky z up y right -4/3*x angle 50 look_at <0.2, 0.1, 0.6> }

polygon { 5, <-3.5, -3, 0>, <3.5, -3, 0>, <3.5, 3, 0>, <-3.5, 3, 0>, <-3.5, -3, 0> Flat(Colour0) }
sphere { <-1.3, -1, 0.6>, 0.9 Flat(Colour1) }
// Where the world is right-handed, so are the rotations of POV-Ray.
box { <-0.5, -0.8, -0.6>, <0.5, 0.8, 0.6> rotate 30*z translate <1.4, 1.2, 0.6> Flat(Colour2) }
cylinder { <-1.5, 1.6, 0.3>, <-0.3, 0.9, 2.1>, 0.45 open Flat(Colour3) }
disc { <1.6, -1.4, 0.9>, <1, -1, 1>, 0.7 Flat(Colour4) }
mesh2 {
  vertex_vectors { 6,
    <0.9, 0, 1.5>, <-0.1, 0, 1.5>, <0.4, 0.6, 1.5>, <0.4, -0.6, 1.5>, <0.4, 0, 2.5>, <0.4, 0, 0.8> }
  face_indices { 8,
    <0, 2, 4>, <2, 1, 4>, <1, 3, 4>, <3, 0, 4>, <2, 0, 5>, <1, 2, 5>, <3, 1, 5>, <0, 3, 5> }
  Flat(Colour5)
}
box { <-1.2, -0.2, -0.7>, <1.2, 0.2, 0.7> translate <-2.6, 3, 2.1> Flat(Colour6) }
