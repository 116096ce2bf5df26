// Curves turned and moved, a patch and a height field, on a floor. Twin: scene.xml.
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

polygon { 5, <-5, -5, 0>, <5, -5, 0>, <5, 5, 0>, <-5, 5, 0>, <-5, -5, 0> Matt(0.5) }
// POV-Ray turns about y; a quarter turn makes that z.
lathe { linear_spline 5, <0, 0>, <0.5, 0>, <0.8, 0.6>, <0.35, 1.1>, <0.5, 1.4> sturm rotate 90*x translate <-2.6, 1.3, 0.02> Matt(0.7) }
lathe {
  bezier_spline 8,
  <0.4, 0>, <0.9, 0.1>, <0.9, 0.6>, <0.3, 0.7>, <0.3, 0.7>, <0.1, 0.8>, <0.1, 1.2>, <0.5, 1.3>
  sturm rotate 90*x rotate -20*x translate <-0.9, 1.5, 0.2> Matt(0.7)
}
sor { 4, <0.3, 0>, <0.5, 0.2>, <0.3, 0.9>, <0.5, 1.2> open sturm rotate 90*x translate <0.8, 1.4, 0.1> Matt(0.7) }
// POV-Ray moves along y what is drawn in x and z.
prism {
  linear_spline linear_sweep 0, 0.9, 7,
  <-0.6, -0.5>, <0.5, -0.6>, <0.2, 0.1>, <0.7, 0.5>, <-0.5, 0.6>, <-0.1, 0>, <-0.6, -0.5>
  matrix <1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0> rotate 15*y translate <2.4, 1.2, 0.25> Matt(0.7)
}
prism {
  bezier_spline linear_sweep 0, 0.7, 12,
  <-0.7, 0>, <-0.7, -1>, <0.7, -1>, <0.7, 0>, <0.7, 0>, <0.7, 0.6>, <0.1, -0.2>, <0, 0.5>, <0, 0.5>, <-0.1, -0.2>, <-0.7, 0.6>, <-0.7, 0>
  sturm matrix <1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0> translate <-2.3, -0.9, 0.02> Matt(0.7)
}
bicubic_patch {
  type 1 flatness 0 u_steps 5 v_steps 5,
  <-1.5, -1.5, 0>, <-0.5, -1.5, 0.6>, <0.5, -1.5, 0.2>, <1.5, -1.5, 0>, <-1.5, -0.5, 0.5>, <-0.5, -0.5, 1.4>, <0.5, -0.5, -0.6>, <1.5, -0.5, 0.3>, <-1.5, 0.5, 0.2>, <-0.5, 0.5, -0.5>, <0.5, 0.5, 1.5>, <1.5, 0.5, 0.4>, <-1.5, 1.5, 0.1>, <-0.5, 1.5, 0.3>, <0.5, 1.5, 0.6>, <1.5, 1.5, 0.9>
  scale 0.5 translate <0, -0.9, 0.3> Matt(0.7)
}
// In the unit cube, its heights along y.
height_field {
  png "heights.png" gamma 1.0
  translate <-0.5, 0, -0.5> scale <2, 0.8, 2> matrix <1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0>
  scale <0.8, 0.6, 1> rotate -20*z translate <2.2, -0.9, 0.05> Matt(0.7)
}
Lamp(<-3, -4, 6>, 90)
