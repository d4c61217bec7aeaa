// clang-format off
#define FLANEUR_SHADER_PROGRAMS(PROGRAM) \
  PROGRAM(kOnly, "only.vert", "only.frag", "")

#define FLANEUR_SHADER_MODES(MODE) \
  MODE(kGood, "") \
  MODE(kBroken, "BROKEN")
