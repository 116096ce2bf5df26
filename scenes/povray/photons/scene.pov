// The caustic of a ball of glass, by POV-Ray's photons. Twin: scene.xml. For the eye: photons are not exact.
#version 3.7;
global_settings {
  assumed_gamma 1.0 max_trace_level 8 adc_bailout 0
  photons { spacing 0.004 autostop 0 max_trace_level 8 }
}

// A right-handed world: the camera's x axis points to the left.
camera { perspective location <0, 2.6, 4.2> sky y up y right -4/3*x angle 51.01277 look_at <0, 0.25, 0> }

// I/d² in the limit: POV-Ray's 2/(1 + (d/f)²) is 2f²/d² for f far below d. POV-Ray leaves out Lambert's 1/π.
#declare F = 0.001;
light_source { <-1.5, 3, 0.6> rgb 12/pi/(2*F*F) fade_distance F fade_power 2 photons { refraction on reflection on } }

polygon {
  5, <-4, 0, -4>, <4, 0, -4>, <4, 0, 4>, <-4, 0, 4>, <-4, 0, -4>
  texture { pigment { color rgb <0.6, 0.55, 0.5> } finish { ambient 0 diffuse 1 } }
}
sphere {
  <0, 0.8, 0>, 0.6
  texture {
    pigment { color rgb 1 transmit 1 }
    finish { ambient 0 diffuse 0 reflection { 0, 1 fresnel on } conserve_energy }
  }
  interior { ior 1.5 }
  photons { target refraction on reflection on }
}
