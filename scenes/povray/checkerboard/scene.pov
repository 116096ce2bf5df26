// Checkerboards of grey squares on a floor and of coloured ones on a turned wall. Twin: scene.xml.
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
camera { perspective location <0.3, -4, 1.8> sky z up y right -4/3*x angle 60 look_at <0, 0, 0.8> }

// `checker` takes its first colour where the whole parts of the coordinates have an even sum, Mitsuba's
// `checkerboard` where those of 2u and 2v do. The squares lie about z = 0, in the middle of a cube's height.
polygon {
  5, <-5, -8, 0>, <5, -8, 0>, <5, 8, 0>, <-5, 8, 0>, <-5, -8, 0>
  texture {
    pigment { checker color rgb 0.15 color rgb 0.75 translate <-5, -8, -0.5> }
    finish { ambient 0 diffuse 1 }
  }
  translate 4*y
}
polygon {
  5, <-1, -0.8, 0>, <1, -0.8, 0>, <1, 0.8, 0>, <-1, 0.8, 0>, <-1, -0.8, 0>
  texture {
    pigment {
      checker color rgb <0.7, 0.55, 0.2> color rgb <0.2, 0.35, 0.3>
      scale 0.4 translate <-1, -0.8, -0.2>
    }
    finish { ambient 0 diffuse 1 }
  }
  rotate 90*x rotate 20*z translate <-1, 1.2, 0.9>
}
Lamp(<0.5, -2, 3>, 24)
