// Things in sunlight, seen beside the picture's middle: a light without a place, an oblique pyramid of view. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 }

#macro Matt(Reflectance)
  texture { pigment { color rgb Reflectance } finish { ambient 0 diffuse 1 } }
#end

// The window's width and height at distance 1, for 50 degrees along the diagonal of 4 × 3. The
// middle of the picture is off the axis by the principal point's offset.
#declare Width = 2*tan(radians(50/2))*4/5*x;
#declare Height = vlength(Width)*3/4*z;
camera {
  perspective location <0.5, -7, 2>
  direction y - 0.06*Width - 0.3*Height
  right Width
  up Height
}

polygon { 5, <-4, -4, 0>, <4, -4, 0>, <4, 4, 0>, <-4, 4, 0>, <-4, -4, 0> Matt(0.5) }
// Where the axes are those of a right-handed world, so are the rotations of POV-Ray.
box { <-0.6, -0.4, -1.1>, <0.6, 0.4, 1.1> rotate 35*z translate <-1.4, 0.8, 1.1> Matt(0.7) }
sphere { <0.9, -0.7, 1.3>, 0.6 Matt(0.7) }
cylinder { <1.2, 1.5, 0>, <2.2, 1.1, 1.9>, 0.4 open Matt(0.7) }
disc { 0, z, 0.7 rotate -40*x translate <-0.3, -1.2, 0.7> Matt(0.7) }
// The irradiance 2.5 on what faces the light; Lambert's 1/π.
light_source { -1000*<0.8, 0.9, -1.2> rgb 2.5/pi parallel point_at 0 }
