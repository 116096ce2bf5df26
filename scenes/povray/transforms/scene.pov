// Ellipsoids, a sheared box, a mirrored instance: normals under transformation. Twin: scene.xml.
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
camera { perspective location <2, -7, 4> sky z up y right -4/3*x angle 40 look_at <0, 0, 0.6> }

#declare Lean = union {
  cylinder { <0.2, 0, 0>, <-0.3, 0.2, 1.4>, 0.35 open }
  sphere { <-0.3, 0.2, 1.4>, 0.5 }
}

polygon { 5, <-4, -4, 0>, <4, -4, 0>, <4, 4, 0>, <-4, 4, 0>, <-4, -4, 0> Matt(0.5) }
// 50 degrees about <0.48, 0.8, 0.36>. Matrices of POV-Ray act on row vectors.
sphere {
  0, 1
  scale <1.2, 0.5, 0.7>
  matrix <0.725089344, 0.412945557, -0.551109253,  -0.138606442, 0.871403539, 0.470578501,  0.674561856, -0.264824164, 0.689082335,  0, 0, 0>
  translate <-1.5, 0.2, 1>
  Matt(0.7)
}
sphere { 0, 1 matrix <0.4, -0.1, 0.3,  0.2, 0.6, 0,  0.1, 0.2, 0.5,  0.3, -1.6, 0.7> Matt(0.7) }
box { -1, 1 matrix <0.5, -0.1, 0,  0.1, 0.5, 0.1,  0.3, 0.2, 0.8,  1.3, 0.5, 0.8> Matt(0.7) }
object { Lean rotate -40*z translate <-0.2, 1.6, 0.1> Matt(0.7) }
object { Lean scale <-1, 1.3, 0.7> translate <2.6, -0.9, 0.1> Matt(0.7) }
Lamp(<0.5, -3.5, 4.5>, 44)
