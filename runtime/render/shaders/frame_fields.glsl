// The fields of the uniform block Frame: what all programs know of the picture. Read by shaders and C++, each
// with a FIELD of its own. Matrices and vectors of four alone: std140 lays them out as C++ does.
FIELD(mat4, view_projection)
FIELD(mat4, inverse_view_projection)
FIELD(mat4, near_shadow)
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
FIELD(vec4, shadow_layers)  // of the town's near and far map, and how far from the eye people's shadows reach
FIELD(vec4, shadow_texels)  // in metres, of the town's near and far map, and of people's fine and coarse one
