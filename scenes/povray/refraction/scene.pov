// Transparent things: refraction, total reflection, shadows that let light through. Twin: scene.xml.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 12 adc_bailout 0 }

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0.3, -6, 2.8> sky z up y right -4/3*x angle 48 look_at <0, 0, 0.7> }

// I/d² in the limit: POV-Ray's 2/(1 + (d/f)²) is 2f²/d² for f far below d.
#declare F = 0.001;
#macro Lamp(Position, Intensity)
  light_source { Position rgb Intensity/(2*F*F) fade_distance F fade_power 2 }
#end
// `transmit` blends the surface's own light with the light behind it; highlights and mirrored light
// are added to both, so that they are reduced here. Under total reflection POV-Ray shows all of the mirrored
// light whatever `transmit` is, so that the box, in which there is total reflection, is quite transparent.
#macro Clear(Diffuse, Specular, Exponent, Global, Alpha, Index)
  texture {
    pigment { color rgb Diffuse transmit Alpha }
    finish {
      ambient 0 diffuse 1
      phong (1 - Alpha)*Specular phong_size Exponent
      reflection (1 - Alpha)*Global
    }
  }
  interior { ior Index }
#end

polygon {
  5, <-5, -5, 0>, <5, -5, 0>, <5, 5, 0>, <-5, 5, 0>, <-5, -5, 0>
  texture {
    pigment { checker color rgb <0.15, 0.3, 0.5> color rgb <0.6, 0.55, 0.3> translate <-5, -5, -0.5> }
    finish { ambient 0 diffuse 1 }
  }
}
polygon {
  5, <-5, 3, 0>, <5, 3, 0>, <5, 3, 3>, <-5, 3, 3>, <-5, 3, 0>
  texture { pigment { color rgb <0.55, 0.25, 0.2> } finish { ambient 0 diffuse 1 } }
}
sphere { <-1.1, 0.1, 0.95>, 0.85 Clear(0.3, 0.8, 80, 0.4, 0.85, 1.5) }
box { <-0.5, -0.5, -0.5>, <0.5, 0.5, 0.5> Clear(0, 0, 1, 0, 1, 1.5) rotate 25*z translate <0.9, -0.2, 0.55> }
sphere { <0.3, -1.9, 0.35>, 0.3 Clear(0.4, 0, 1, 0, 0.7, 1.33) }
polygon {
  5, <-0.6, -0.7, 0>, <0.6, -0.7, 0>, <0.6, 0.7, 0>, <-0.6, 0.7, 0>, <-0.6, -0.7, 0>
  Clear(0.4, 0, 1, 0, 0.5, 1) rotate 90*x rotate 30*z translate <1.9, 1.2, 0.9>
}
Lamp(<2.2, -2.5, 4>, 16)
Lamp(<-3, -1, 3.4>, 8)
