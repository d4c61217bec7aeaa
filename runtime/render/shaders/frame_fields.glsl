// The fields of the uniform block Frame: what all programs know of the picture. Read by shaders and C++, each
// with a FIELD of its own. Matrices and vectors of four alone: std140 lays them out as C++ does.
FIELD(mat4, view_projection)
FIELD(mat4, inverse_view_projection)
FIELD(mat4, near_shadow)    // of the town
FIELD(mat4, middle_shadow)
FIELD(mat4, far_shadow)
FIELD(mat4, fine_shadow)    // of people near the eye
FIELD(mat4, people_shadow)  // of people beyond
FIELD(vec4, eye)            // w: pixels that a metre takes at a distance of one
FIELD(vec4, to_sun)
FIELD(vec4, sun_color)
FIELD(vec4, sky_color)
FIELD(vec4, ground_color)
FIELD(vec4, haze_color)
FIELD(vec4, zenith_color)
FIELD(vec4, town_shadow_layers)  // of the town's near, middle and far map
FIELD(vec4, town_shadow_texels)  // theirs, in metres
FIELD(vec4, people_shadows)      // in metres: texels of people's fine and coarse map, how far from the eye they reach
