// A bowl, a sheared torus, cones, a rounded box, a star, a blob, a gyroid and solids of solids, on a plane without end. Twin: scene.xml.
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
  perspective location <-1, -8, 6> sky z up y right -4/3*x angle Horizontal look_at <0, 0, 0.4>
}

plane { z, 0 Matt(0.5) }
intersection {
  quadric { <1, 1, 0>, <0, 0, 0>, <0, 0, -1>, 0 }
  box { <-0.9, -0.9, -0.1>, <0.9, 0.9, 0.7> }
  translate <-2.6, 1.4, 0.05> Matt(0.7)
}
// Around y, as POV-Ray has it, made one around z; then sheared.
torus { 0.6, 0.25 rotate 90*x matrix <1, 0, 0.1, 0.3, 1.1, 0, 0.5, 0, 0.9, -0.8, 1.5, 0.45> Matt(0.7) }
cone { <0.9, 1.9, 0>, 0.5, <1.1, 1.5, 1.3>, 0.2 Matt(0.7) }
superellipsoid { <0.4, 0.3> scale 0.55 rotate 30*z translate <2.5, 1.2, 0.55> Matt(0.7) }
superellipsoid { <1.6, 1.3> scale 0.8 rotate 20*z translate <-2.5, -0.7, 0.8> Matt(0.7) }
blob {
  threshold 0.5
  sphere { <-0.4, 0, 0>, 0.9, 1 }
  sphere { <0.4, 0.1, 0>, 0.8, 1.2 }
  sphere { <0, -0.4, 0.4>, 0.5, -0.6 }
  translate <-0.8, -0.8, 0.6> Matt(0.7)
}
isosurface {
  function { sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x) }
  contained_by { box { <-1, -1, -1>, <1, 1, 1> } }
  threshold 0 accuracy 1e-6 max_gradient 7
  scale 0.6 translate <1, -0.8, 0.6> Matt(0.7)
}
difference {
  intersection { sphere { 0, 0.75 } box { -0.6, 0.6 } Matt(0.7) }
  union { cylinder { -z, z, 0.35 } cylinder { -x, x, 0.35 } Matt(0.3) }
  rotate 35*z translate <2.6, -0.9, 0.6>
}
Lamp(<-3, -4, 6>, 90)
