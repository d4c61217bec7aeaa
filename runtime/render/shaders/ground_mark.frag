out vec4 o_color;
void main() { o_color = vec4(1.0, 0.82, 0.40, 0.8); }
