// What is left of what is there.
in float v_out;
in float v_strength;
out vec4 o_left;
void main() {
  float near = 1.0 - v_out;
  o_left = vec4(1.0 - v_strength * near * near);
}
