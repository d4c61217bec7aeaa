// A strip of text at the foot of the picture, pixel by pixel.
uniform sampler2D u_texture;
uniform float u_share;
out vec4 o_color;
void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  o_color = texelFetch(u_texture, ivec2(p.x, textureSize(u_texture, 0).y - 1 - p.y), 0);
  o_color.a *= u_share;
}
