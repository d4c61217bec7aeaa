#include "pipeline/rig/face_names.h"

#include <string_view>
#include <vector>

#include "pipeline/core/name_words.h"

namespace flaneur {
namespace {

struct Word {
  std::string_view text;
  FaceMove move;
  int rank;
};

// What a name ends in, without its side. A mouth opens widest by its jaw.
constexpr Word kEndings[] = {{"blink", FaceMove::kBlink, 0},          {"eyesblink", FaceMove::kBlink, 0},
                             {"eyeclose", FaceMove::kBlink, 0},       {"eyeclosed", FaceMove::kBlink, 0},
                             {"eyesclose", FaceMove::kBlink, 0},      {"eyesclosed", FaceMove::kBlink, 0},
                             {"upperlidclosed", FaceMove::kBlink, 0}, {"jawopen", FaceMove::kOpenMouth, 0},
                             {"mouthopen", FaceMove::kOpenMouth, 1},  {"visemeaa", FaceMove::kOpenMouth, 2},
                             {"vaa", FaceMove::kOpenMouth, 2},        {"vopen", FaceMove::kOpenMouth, 2},
                             {"mtha", FaceMove::kOpenMouth, 2}};
// Whole names.
constexpr Word kWholes[] = {{"aa", FaceMove::kOpenMouth, 3},
                            {"ah", FaceMove::kOpenMouth, 3},
                            {"a", FaceMove::kOpenMouth, 3},
                            {"あ", FaceMove::kOpenMouth, 3},
                            {"まばたき", FaceMove::kBlink, 0}};

}  // namespace

FaceName ReadFaceName(const std::string& name) {
  FaceName read;
  std::string joined;
  for (const std::string& word : NameWords(name)) {
    const bool left = word == "left" || word == "l", right = word == "right" || word == "r";
    if (left || right) read.side = left ? BodySide::kLeft : BodySide::kRight;
    if (!left && !right) joined += word;
  }
  const auto take = [&](const Word& word) { read.move = word.move, read.rank = word.rank; };
  for (const Word& word : kWholes) {
    if (joined == word.text || name == word.text) take(word);
  }
  for (const Word& word : kEndings) {
    if (joined.ends_with(word.text)) take(word);
  }
  if (read.move == FaceMove::kOpenMouth && read.side != BodySide::kNone) return {};
  if (read.side != BodySide::kNone) ++read.rank;
  return read;
}

}  // namespace flaneur
