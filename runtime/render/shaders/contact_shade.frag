// What is left of what is there.
in vec2 v_at;
flat in float v_strength;
out vec4 o_left;
void main() {
  float near = max(0.0, 1.0 - dot(v_at, v_at));
  o_left = vec4(1.0 - v_strength * near * near);
}
