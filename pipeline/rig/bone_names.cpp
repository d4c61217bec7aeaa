#include "pipeline/rig/bone_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace flaneur {
namespace {

using Token = std::string;

struct Word {
  std::string_view text;
  BodyPart part;
};

// A name's words without sides, numbers and what only tells whose rig it is, written together.
constexpr std::array kWords = {
    Word{"hips", BodyPart::kHips},          Word{"hip", BodyPart::kHips},
    Word{"pelvis", BodyPart::kHips},        Word{"spine", BodyPart::kSpine},
    Word{"chest", BodyPart::kSpine},        Word{"upperchest", BodyPart::kSpine},
    Word{"chestupper", BodyPart::kSpine},   Word{"chestlower", BodyPart::kSpine},
    Word{"torso", BodyPart::kSpine},        Word{"abdomen", BodyPart::kSpine},
    Word{"abdomenlower", BodyPart::kSpine}, Word{"abdomenupper", BodyPart::kSpine},
    Word{"waist", BodyPart::kSpine},        Word{"lowerback", BodyPart::kSpine},
    Word{"upperbody", BodyPart::kSpine},    Word{"stomach", BodyPart::kSpine},
    Word{"belly", BodyPart::kSpine},        Word{"tummy", BodyPart::kSpine},
    Word{"ribs", BodyPart::kSpine},         Word{"ribcage", BodyPart::kSpine},
    Word{"body", BodyPart::kSpine},         Word{"neck", BodyPart::kNeck},
    Word{"necklower", BodyPart::kNeck},     Word{"neckupper", BodyPart::kNeck},
    Word{"head", BodyPart::kHead},          Word{"clavicle", BodyPart::kClavicle},
    Word{"collar", BodyPart::kClavicle},    Word{"collarbone", BodyPart::kClavicle},
    Word{"scapula", BodyPart::kClavicle},   Word{"shoulder", BodyPart::kShoulder},
    Word{"upperarm", BodyPart::kUpperArm},  Word{"armupper", BodyPart::kUpperArm},
    Word{"uparm", BodyPart::kUpperArm},     Word{"shldr", BodyPart::kUpperArm},
    Word{"shldrbend", BodyPart::kUpperArm}, Word{"bicep", BodyPart::kUpperArm},
    Word{"humerus", BodyPart::kUpperArm},   Word{"arm", BodyPart::kArm},
    Word{"lowerarm", BodyPart::kLowerArm},  Word{"armlower", BodyPart::kLowerArm},
    Word{"loarm", BodyPart::kLowerArm},     Word{"lowarm", BodyPart::kLowerArm},
    Word{"forearm", BodyPart::kLowerArm},   Word{"forearmbend", BodyPart::kLowerArm},
    Word{"elbow", BodyPart::kLowerArm},     Word{"hand", BodyPart::kHand},
    Word{"wrist", BodyPart::kHand},         Word{"upperleg", BodyPart::kUpperLeg},
    Word{"legupper", BodyPart::kUpperLeg},  Word{"upleg", BodyPart::kUpperLeg},
    Word{"thigh", BodyPart::kUpperLeg},     Word{"thighbend", BodyPart::kUpperLeg},
    Word{"femur", BodyPart::kUpperLeg},     Word{"leg", BodyPart::kLeg},
    Word{"lowerleg", BodyPart::kLowerLeg},  Word{"leglower", BodyPart::kLowerLeg},
    Word{"loleg", BodyPart::kLowerLeg},     Word{"lowleg", BodyPart::kLowerLeg},
    Word{"shin", BodyPart::kLowerLeg},      Word{"calf", BodyPart::kLowerLeg},
    Word{"knee", BodyPart::kLowerLeg},      Word{"foot", BodyPart::kFoot},
    Word{"ankle", BodyPart::kFoot},         Word{"toe", BodyPart::kToes},
    Word{"toes", BodyPart::kToes},          Word{"ball", BodyPart::kToes},
    Word{"toebase", BodyPart::kToes},       Word{"uarm", BodyPart::kUpperArm},
    Word{"farm", BodyPart::kLowerArm},      Word{"shank", BodyPart::kLowerLeg},
    Word{"palm", BodyPart::kHand},          Word{"neckhead", BodyPart::kHead},
    Word{"legankle", BodyPart::kFoot},      Word{"legfoot", BodyPart::kFoot},
    Word{"legtoe", BodyPart::kToes},        Word{"armpalm", BodyPart::kHand},
    Word{"armhand", BodyPart::kHand},
};

// German, French, Spanish and Italian, as they are written without accents.
constexpr std::array kOtherWords = {
    Word{"becken", BodyPart::kHips},
    Word{"bassin", BodyPart::kHips},
    Word{"cadera", BodyPart::kHips},
    Word{"bacino", BodyPart::kHips},
    Word{"kopf", BodyPart::kHead},
    Word{"tete", BodyPart::kHead},
    Word{"cabeza", BodyPart::kHead},
    Word{"testa", BodyPart::kHead},
    Word{"hals", BodyPart::kNeck},
    Word{"cou", BodyPart::kNeck},
    Word{"cuello", BodyPart::kNeck},
    Word{"collo", BodyPart::kNeck},
    Word{"schulter", BodyPart::kShoulder},
    Word{"epaule", BodyPart::kShoulder},
    Word{"hombro", BodyPart::kShoulder},
    Word{"spalla", BodyPart::kShoulder},
    Word{"oberarm", BodyPart::kUpperArm},
    Word{"bras", BodyPart::kArm},
    Word{"brazo", BodyPart::kArm},
    Word{"braccio", BodyPart::kArm},
    Word{"unterarm", BodyPart::kLowerArm},
    Word{"avantbras", BodyPart::kLowerArm},
    Word{"antebrazo", BodyPart::kLowerArm},
    Word{"avambraccio", BodyPart::kLowerArm},
    Word{"main", BodyPart::kHand},
    Word{"mano", BodyPart::kHand},
    Word{"oberschenkel", BodyPart::kUpperLeg},
    Word{"cuisse", BodyPart::kUpperLeg},
    Word{"muslo", BodyPart::kUpperLeg},
    Word{"coscia", BodyPart::kUpperLeg},
    Word{"bein", BodyPart::kLeg},
    Word{"jambe", BodyPart::kLeg},
    Word{"pierna", BodyPart::kLeg},
    Word{"gamba", BodyPart::kLeg},
    Word{"unterschenkel", BodyPart::kLowerLeg},
    Word{"mollet", BodyPart::kLowerLeg},
    Word{"pantorrilla", BodyPart::kLowerLeg},
    Word{"polpaccio", BodyPart::kLowerLeg},
    Word{"fuss", BodyPart::kFoot},
    Word{"pied", BodyPart::kFoot},
    Word{"pie", BodyPart::kFoot},
    Word{"piede", BodyPart::kFoot},
    Word{"zehen", BodyPart::kToes},
    Word{"orteils", BodyPart::kToes},
};

// The parts of a finger's name, with or without the hand's.
constexpr std::array kFingerWords = {
    Word{"thumb", BodyPart::kThumb},    Word{"index", BodyPart::kIndex},   Word{"middle", BodyPart::kMiddle},
    Word{"mid", BodyPart::kMiddle},     Word{"ring", BodyPart::kRing},     Word{"pinky", BodyPart::kLittle},
    Word{"pinkie", BodyPart::kLittle},  Word{"little", BodyPart::kLittle}, Word{"finger", BodyPart::kFinger},
    Word{"fingers", BodyPart::kFinger},
};

// Japanese and Chinese; the first that is found counts.
constexpr std::array kIdeographs = {
    Word{"足首", BodyPart::kFoot},     Word{"つま先", BodyPart::kToes},   Word{"手首", BodyPart::kHand},
    Word{"ひざ", BodyPart::kLowerLeg}, Word{"膝", BodyPart::kLowerLeg},   Word{"小腿", BodyPart::kLowerLeg},
    Word{"大腿", BodyPart::kUpperLeg}, Word{"脚趾", BodyPart::kToes},     Word{"脚踝", BodyPart::kFoot},
    Word{"ひじ", BodyPart::kLowerArm}, Word{"肘", BodyPart::kLowerArm},   Word{"前臂", BodyPart::kLowerArm},
    Word{"下臂", BodyPart::kLowerArm}, Word{"小臂", BodyPart::kLowerArm}, Word{"上臂", BodyPart::kUpperArm},
    Word{"大臂", BodyPart::kUpperArm}, Word{"手腕", BodyPart::kHand},     Word{"腕", BodyPart::kUpperArm},
    Word{"锁骨", BodyPart::kClavicle}, Word{"肩", BodyPart::kShoulder},   Word{"下半身", BodyPart::kHips},
    Word{"骨盆", BodyPart::kHips},     Word{"腰", BodyPart::kHips},       Word{"上半身", BodyPart::kSpine},
    Word{"脊", BodyPart::kSpine},      Word{"胸", BodyPart::kSpine},      Word{"頭", BodyPart::kHead},
    Word{"头", BodyPart::kHead},       Word{"首", BodyPart::kNeck},       Word{"脖", BodyPart::kNeck},
    Word{"颈", BodyPart::kNeck},       Word{"足", BodyPart::kUpperLeg},   Word{"腿", BodyPart::kLeg},
    Word{"脚", BodyPart::kFoot},       Word{"手", BodyPart::kHand},
};
constexpr std::array<std::string_view, 6> kIdeographsOfNoBody = {"ＩＫ", "IK", "捩", "先", "親", "指"};

// Whose rig it is, and what says nothing about where.
constexpr std::array<std::string_view, 27> kIdle = {
    "mixamorig", "bip",      "biped",     "valve",  "def",  "deform", "bn", "bone",    "jnt",
    "joint",     "jt",       "cc",        "base",   "j",    "b",      "sk", "c",       "rig",
    "armature",  "skeleton", "character", "center", "gltf", "bind",   "m",  "stretch", "x"};

constexpr size_t kFewest = 6;   // bones of a figure that bears its name on them
constexpr int kOwnerWords = 4;  // of which the name is made at most

bool IsIdle(const Token& token) { return std::find(kIdle.begin(), kIdle.end(), token) != kIdle.end(); }

enum class Kind { kLower, kUpper, kDigit, kOther };

Kind KindOf(char c) {
  const auto u = static_cast<unsigned char>(c);
  if (std::islower(u)) return Kind::kLower;
  if (std::isupper(u)) return Kind::kUpper;
  return std::isdigit(u) ? Kind::kDigit : Kind::kOther;
}

// "mixamorig:LeftUpLeg_07" becomes mixamorig, left, up, leg, 07; capitals that end a run belong to the next word.
std::vector<Token> Tokens(const std::string& name) {
  std::vector<Token> tokens;
  Token current;
  const auto finish = [&] {
    if (!current.empty()) tokens.push_back(std::exchange(current, {}));
  };
  for (size_t i = 0; i < name.size(); ++i) {
    const Kind kind = KindOf(name[i]);
    const Kind before = i > 0 ? KindOf(name[i - 1]) : Kind::kOther;
    const Kind after = i + 1 < name.size() ? KindOf(name[i + 1]) : Kind::kOther;
    const bool letters = kind == Kind::kLower || kind == Kind::kUpper;
    const bool after_letters = before == Kind::kLower || before == Kind::kUpper;
    const bool new_word =
        kind == Kind::kUpper && (before == Kind::kLower || (before == Kind::kUpper && after == Kind::kLower));
    if (kind == Kind::kOther || new_word || letters != after_letters) finish();
    if (kind != Kind::kOther) current += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
  }
  finish();
  return tokens;
}

BodySide SideOf(const Token& token) {
  static constexpr std::array<std::string_view, 9> kLefts = {"l",         "left",      "lft",      "links",   "gauche",
                                                             "izquierda", "izquierdo", "sinistra", "sinistro"};
  static constexpr std::array<std::string_view, 10> kRights = {"r",     "right",   "rgt",     "rechts", "droite",
                                                               "droit", "derecha", "derecho", "destra", "destro"};
  if (std::find(kLefts.begin(), kLefts.end(), token) != kLefts.end()) return BodySide::kLeft;
  if (std::find(kRights.begin(), kRights.end(), token) != kRights.end()) return BodySide::kRight;
  return BodySide::kNone;
}

template <typename Known>
BodyPart PartIn(const Known& known, const std::string& words) {
  const auto* found = std::find_if(known.begin(), known.end(), [&](const Word& word) { return word.text == words; });
  return found == known.end() ? BodyPart::kNone : found->part;
}

BodyPart PartOf(const std::string& words) {
  const BodyPart part = PartIn(kWords, words);
  return part == BodyPart::kNone ? PartIn(kOtherWords, words) : part;
}

BodyPart FingerOf(const std::vector<Token>& words) {
  static constexpr std::array<std::string_view, 9> kBeside = {
      "hand", "finger", "proximal", "intermediate", "distal", "metacarpal", "f", "knuckle", "phalange"};
  BodyPart part = BodyPart::kNone;
  for (const Token& word : words) {
    const auto* known =
        std::find_if(kFingerWords.begin(), kFingerWords.end(), [&](const Word& w) { return w.text == word; });
    if (known != kFingerWords.end()) {
      if (part == BodyPart::kNone || part == BodyPart::kFinger) part = known->part;
    } else if (std::find(kBeside.begin(), kBeside.end(), word) == kBeside.end()) {
      return BodyPart::kNone;
    }
  }
  return part;
}

BoneName ReadIdeographs(const std::string& name) {
  BoneName read;
  for (const std::string_view no_body : kIdeographsOfNoBody) {
    if (name.find(no_body) != std::string::npos && name.find("つま先") == std::string::npos) return read;
  }
  for (const Word& word : kIdeographs) {
    if (name.find(word.text) == std::string::npos) continue;
    read.part = word.part;
    break;
  }
  if (name.find("左") != std::string::npos) read.side = BodySide::kLeft;
  if (name.find("右") != std::string::npos) read.side = BodySide::kRight;
  return read;
}

bool IsAscii(const std::string& name) {
  return std::all_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
}

// "foot", and "handthumb".
BodyPart PartOrFingerOf(const std::string& word) {
  const BodyPart part = PartOf(word);
  return part == BodyPart::kNone && word.starts_with("hand") ? FingerOf({word.substr(4)}) : part;
}

// Where side and part stand in one word of small letters or of capitals: "leftarm", "rshoulder", "handl".
BoneName ReadJoined(const std::string& word) {
  static constexpr std::array<std::pair<std::string_view, BodySide>, 4> kSides = {
      std::pair{std::string_view("left"), BodySide::kLeft}, std::pair{std::string_view("right"), BodySide::kRight},
      std::pair{std::string_view("l"), BodySide::kLeft}, std::pair{std::string_view("r"), BodySide::kRight}};
  for (const auto& [text, side] : kSides) {
    if (word.size() <= text.size() + 2) continue;
    if (word.starts_with(text)) {
      const BodyPart part = PartOrFingerOf(word.substr(text.size()));
      if (part != BodyPart::kNone) return {part, side, -1};
    }
    if (word.ends_with(text)) {
      const BodyPart part = PartOrFingerOf(word.substr(0, word.size() - text.size()));
      if (part != BodyPart::kNone) return {part, side, -1};
    }
  }
  return {};
}

// Without the namespace, and without the short form that some write behind: "NPC L Thigh [LThg]".
std::string OwnName(const std::string& whole) {
  const size_t space = whole.find_last_of("|:");
  const std::string name = space == std::string::npos || space + 1 == whole.size() ? whole : whole.substr(space + 1);
  const size_t bracket = name.ends_with("]") ? name.rfind(" [") : std::string::npos;
  return bracket == std::string::npos ? name : name.substr(0, bracket);
}

// "bras g", "mano i", "braccio s": gauche, izquierda, sinistra; the other side is d in all three.
BoneName ReadInitial(const std::vector<Token>& words) {
  if (words.size() < 2) return {};
  const Token& initial = words.back();
  const bool left = initial == "g" || initial == "i" || initial == "s";
  if (!left && initial != "d") return {};
  std::string joined;
  for (size_t w = 0; w + 1 < words.size(); ++w) joined += words[w];
  const BodyPart part = PartIn(kOtherWords, joined);
  return part == BodyPart::kNone ? BoneName{} : BoneName{part, left ? BodySide::kLeft : BodySide::kRight, -1};
}

BoneName ReadTokens(const std::vector<Token>& tokens) {
  BoneName read;
  std::vector<Token> words;
  std::string joined;
  for (const Token& token : tokens) {
    const bool number = KindOf(token[0]) == Kind::kDigit;
    if (number && !words.empty() && read.number < 0) read.number = std::stoi(token.substr(0, 6));
    if (number || IsIdle(token)) continue;
    if (const BodySide side = SideOf(token); side != BodySide::kNone) {
      read.side = side;
      continue;
    }
    words.push_back(token);
    joined += token;
  }
  read.part = PartOf(joined);
  if (read.part == BodyPart::kNone && !words.empty()) read.part = FingerOf(words);
  if (read.part == BodyPart::kNone && read.side == BodySide::kNone) {
    BoneName together = ReadInitial(words);
    if (together.part == BodyPart::kNone) together = ReadJoined(joined);
    read.part = together.part;
    read.side = together.side;
  }
  return read;
}

// `tokens`: the name's, without what most names of the rig begin with.
BoneName ReadOwnName(const std::string& name, const std::vector<Token>& tokens) {
  if (!IsAscii(name)) return ReadIdeographs(name);
  if (name.starts_with("__")) return {};  // MakeHuman's links between bones
  return ReadTokens(tokens);
}

// That most of the names begin with, and that is no word for a part or a side; empty where there is none.
Token SharedFirst(const std::vector<std::vector<Token>>& names) {
  std::map<Token, size_t> begin;
  for (const std::vector<Token>& tokens : names) {
    if (!tokens.empty()) ++begin[tokens[0]];
  }
  for (const auto& [token, count] : begin) {
    if (3 * count < 2 * names.size() || count < kFewest) continue;
    const bool says =
        SideOf(token) != BodySide::kNone || PartOf(token) != BodyPart::kNone || FingerOf({token}) != BodyPart::kNone;
    return says ? Token{} : token;
  }
  return {};
}

}  // namespace

BoneName ReadBoneName(const std::string& whole) {
  const std::string name = OwnName(whole);
  return ReadOwnName(name, Tokens(name));
}

std::vector<BoneName> ReadWithoutOwner(const std::vector<std::string>& names) {
  std::vector<std::vector<Token>> all;
  for (const std::string& name : names) all.push_back(Tokens(OwnName(name)));
  bool owned = false;
  for (int word = 0; word < kOwnerWords; ++word) {
    const Token first = SharedFirst(all);
    if (first.empty()) break;
    for (std::vector<Token>& tokens : all) {
      if (!tokens.empty() && tokens[0] == first) tokens.erase(tokens.begin());
    }
    owned = true;
  }
  std::vector<BoneName> read;
  if (!owned) return read;
  for (size_t i = 0; i < names.size(); ++i) read.push_back(ReadOwnName(OwnName(names[i]), all[i]));
  return read;
}

}  // namespace flaneur
