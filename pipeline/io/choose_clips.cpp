#include "pipeline/io/choose_clips.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "pipeline/core/name_words.h"
#include "pipeline/io/gltf_names.h"
#include "runtime/base/array.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr const char* kShipped = "flaneur";  // as a file: the clips that come with the program

std::string Lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string Listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    if (!list.empty()) list += ", ";
    list += Quoted(name);
  }
  return names.empty() ? "no clips" : list;
}

// Any of its channels has two keys that differ.
bool Moves(const DocumentClip& clip) {
  return std::any_of(clip.channels.begin(), clip.channels.end(), [](const DocumentChannel& channel) {
    const auto differs = [&](const Vec4& v) {
      const Vec4& first = channel.values.front();
      return v.x != first.x || v.y != first.y || v.z != first.z || v.w != first.w;
    };
    return std::any_of(channel.values.begin(), channel.values.end(), differs);
  });
}

template <class Words>
bool HasAnyOf(const std::string& name, const Words& these) {
  const std::vector<std::string> words = NameWords(name);
  return std::find_first_of(words.begin(), words.end(), std::begin(these), std::end(these)) != words.end();
}

// Whether a name says that something else is done than strolling, standing or talking through a town.
bool SaysMore(const std::string& name) {
  static constexpr std::string_view kOthers[] = {
      "aim",   "attack",   "back",    "backward", "backwards", "block",  "bow",     "carry",  "cheer",
      "clap",  "climb",    "combat",  "crawl",    "crouch",    "dance",  "dancing", "dead",   "death",
      "die",   "fall",     "falling", "fight",    "fly",       "gun",    "hang",    "hit",    "jump",
      "left",  "lie",      "lying",   "melee",    "pistol",    "ranged", "ride",    "riding", "rifle",
      "right", "shield",   "shoot",   "sit",      "sitting",   "sleep",  "sneak",   "spear",  "strafe",
      "swim",  "swimming", "sword",   "wave",     "waving",    "weapon", "zombie"};
  return HasAnyOf(name, kOthers);
}

bool Contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

// Whether the name says the same in another word or language. Poses and ways from one to another do not.
bool SaysOtherwise(const std::string& name, const std::string& word) {
  using Words = std::vector<std::string_view>;
  static const std::map<std::string_view, std::pair<Words, Words>> kOthers = {
      {"walk",
       {{"stroll", "strolling", "gehen", "gehend", "laufen", "marche", "marcher", "caminar", "caminando", "andar",
         "andando", "camminare", "camminata", "lopen", "wandelen"},
        {"步行", "行走", "走路", "歩", "걷"}}},
      {"idle",
       {{"stand", "standing", "breathe", "breathing", "wait", "waiting", "stehen", "stehend", "warten", "debout",
         "attente", "reposo", "espera", "fermo", "attesa", "staan"},
        {"待机", "待機", "站立", "立ち", "대기"}}},
      {"talk",
       {{"speak", "speaking", "conversation", "chat", "chatting", "reden", "sprechen", "parler", "hablar", "hablando",
         "parlare", "praten"},
        {"说话", "說話", "話す", "会話", "말하"}}}};
  static constexpr std::string_view kBetween[] = {"up", "down", "to", "pose", "tpose", "apose"};
  const auto others = kOthers.find(word);
  if (others == kOthers.end()) return false;
  if (HasAnyOf(name, kBetween)) return false;
  const auto& [letters, ideographs] = others->second;
  return HasAnyOf(name, letters) ||
         std::any_of(ideographs.begin(), ideographs.end(), [&](auto w) { return Contains(name, w); });
}

// Of the names that say it the shortest is the plainest; file order breaks ties. Who walks may do so with a weapon
// where there is no other walk; who stands does not hang in the air. -1: none.
template <typename SaysIt>
int PlainestClip(const std::vector<std::string>& names, const std::string& word, SaysIt says_it) {
  int best = -1;
  bool best_says_more = false;
  for (size_t i = 0; i < names.size(); ++i) {
    const bool says_more = SaysMore(names[i]);
    if (!says_it(names[i]) || (says_more && (word == "idle" || word == "talk"))) continue;
    const bool is_plainer =
        says_more != best_says_more ? best_says_more : best >= 0 && names[i].size() < At(names, best).size();
    if (best < 0 || is_plainer) best = static_cast<int>(i), best_says_more = says_more;
  }
  return best;
}

// That very name, else one that contains the word, else one that says it in another. -1: none.
int GuessClip(const std::vector<std::string>& names, const std::string& word) {
  const auto is_named = [&](const std::string& name) {
    return Lower(name).substr(Lower(name).find_last_of('|') + 1) == word;
  };
  const auto named = std::find_if(names.begin(), names.end(), is_named);
  if (named != names.end()) return static_cast<int>(named - names.begin());
  const int plain = PlainestClip(names, word, [&](const std::string& name) { return Contains(Lower(name), word); });
  return plain >= 0 ? plain
                    : PlainestClip(names, word, [&](const std::string& name) { return SaysOtherwise(name, word); });
}

// Of that very name, upper and lower case alike; what a program writes before a bar need not be given.
int NamedClip(const std::vector<std::string>& names, const std::string& wanted) {
  for (const bool whole : {true, false}) {
    for (size_t i = 0; i < names.size(); ++i) {
      const size_t bar = names[i].find_last_of('|');
      const std::string name = whole || bar == std::string::npos ? names[i] : names[i].substr(bar + 1);
      if (Lower(name) == Lower(wanted)) return static_cast<int>(i);
    }
  }
  return -1;
}

class Chooser {
 public:
  Chooser(const GltfDocument& document, const ReadAvatarOptions& options, LoneClip lone, ClipChoice* choice)
      : document_(document), options_(options), lone_(lone), choice_(*choice) {
    for (const DocumentClip& clip : document.clips) own_.push_back(clip.name);
  }

  Error Choose() {
    for (const auto& file : options_.clip_files) {
      int opened = -1;
      if (Error e = OpenOnce(file, &opened)) return e;
      library_.push_back(opened);
    }
    const std::pair<const char*, const std::string*> usual[] = {
        {"walk", &options_.walk}, {"idle", &options_.idle}, {"talk", &options_.talk}};
    for (const auto& [name, given] : usual) {
      if (Error e = ChooseUsual(name, *given)) return e;
    }
    for (const ClipRequest& request : options_.other_clips) {
      if (Has(request.name)) continue;
      if (Error e = ChooseOther(request)) return e;
    }
    return Ok();
  }

 private:
  bool Has(const std::string& name) const {
    return std::any_of(choice_.clips.begin(), choice_.clips.end(), [&](const auto& clip) { return clip.name == name; });
  }

  Error OpenOnce(const std::filesystem::path& file, int* opened) {
    const bool shipped = file == kShipped;
    const std::filesystem::path path = shipped ? ShippedClips() : file;
    for (size_t i = 0; i < choice_.files.size(); ++i) {
      if (choice_.files[i].path != path.string()) continue;
      *opened = static_cast<int>(i);
      return Ok();
    }
    choice_.files.emplace_back();
    if (Error e = OpenMotion(path, &choice_.files.back())) return e;
    *opened = Count(choice_.files) - 1;
    if (shipped) choice_.shipped = *opened;
    return Ok();
  }

  // Other files, then the avatar's.
  std::vector<int> AllFiles() const {
    std::vector<int> files = library_;
    files.push_back(-1);
    return files;
  }

  const std::vector<std::string>& NamesIn(int file) const {
    return file < 0 ? own_ : At(choice_.files, file).clip_names;
  }

  bool MovesIn(int file, int clip) const {
    if (file < 0) return Moves(At(document_.clips, clip));
    const MotionFile& motion = At(choice_.files, file);
    return motion.document.clips.empty() || Moves(At(motion.document.clips, clip));
  }

  void Take(const std::string& name, int file, int clip) {
    choice_.clips.push_back({name, file, static_cast<size_t>(clip)});
  }

  // Where a clip of that very name is, in other files, then in the avatar's, then in the program's.
  Error TakeNamed(const std::string& name, const std::string& wanted) {
    std::vector<std::string> known;
    for (const int file : AllFiles()) {
      const int clip = NamedClip(NamesIn(file), wanted);
      if (clip >= 0) {
        if (!MovesIn(file, clip) && name == "walk") return Fail("walk clip " + Quoted(wanted) + " moves nothing");
        Take(name, file, clip);
        return Ok();
      }
      known.insert(known.end(), NamesIn(file).begin(), NamesIn(file).end());
    }
    int shipped = -1;
    if (!OpenOnce(kShipped, &shipped)) {
      const int clip = NamedClip(NamesIn(shipped), wanted);
      if (clip >= 0) Take(name, shipped, clip);
      if (clip >= 0) return Ok();
    }
    return Fail("no clip " + Quoted(wanted) + DidYouMean(wanted, known) + " (the file has: " + Listed(known) + ")");
  }

  Error ChooseUsual(const std::string& name, const std::string& given) {
    const auto own_file = std::find_if(options_.other_clips.begin(), options_.other_clips.end(),
                                       [&](const ClipRequest& r) { return r.name == name && !r.file.empty(); });
    if (own_file != options_.other_clips.end()) return ChooseOther(*own_file);
    if (!given.empty()) return TakeNamed(name, given);
    if (std::any_of(library_.begin(), library_.end(), [&](int file) { return TakeGuess(name, file); })) return Ok();
    if (name == "walk" && lone_ == LoneClip::kWalk && TakeLone(name, library_, false)) {
      choice_.lone_walk = true;
      return Ok();
    }
    if (TakeGuess(name, -1)) return Ok();
    if (name == "walk") return ChooseAnyWalk();
    if (name == "idle" && lone_ == LoneClip::kIdle && TakeLoneOfAny(name)) return Ok();
    if (name == "talk" && !choice_.shipped_idle) return Ok();  // talks as they stand
    int shipped = -1;
    if (Error e = OpenOnce(kShipped, &shipped)) return e;
    if (name == "idle") choice_.shipped_idle = true;
    TakeShipped(name);
    return Ok();
  }

  bool TakeGuess(const std::string& name, int file) {
    const int clip = GuessClip(NamesIn(file), name);
    if (clip < 0 || (name == "walk" && !MovesIn(file, clip))) return false;
    Take(name, file, clip);
    return true;
  }

  // The first file's that has one alone, and one whose name says that it is something else only `whatever_its_name`.
  bool TakeLone(const std::string& name, const std::vector<int>& files, bool whatever_its_name) {
    for (const int file : files) {
      const std::vector<std::string>& names = NamesIn(file);
      if (names.size() != 1 || !MovesIn(file, 0) || (!whatever_its_name && IsNoWalk(names.front()))) continue;
      Take(name, file, 0);
      return true;
    }
    return false;
  }

  bool TakeLoneOfAny(const std::string& name) {
    const std::vector<int> files = AllFiles();
    return TakeLone(name, files, false) || TakeLone(name, files, true);
  }

  Error ChooseAnyWalk() {
    choice_.lone_walk = lone_ == LoneClip::kWalk && TakeLoneOfAny("walk");
    if (choice_.lone_walk) return Ok();
    choice_.missing = "the file has: " + Listed(own_) + (own_.empty() ? "" : "; name the one to walk with");
    for (const int file : AllFiles()) {
      if (const int still = GuessClip(NamesIn(file), "walk"); still >= 0)
        choice_.missing = Quoted(At(NamesIn(file), still)) + " moves nothing";
    }
    int shipped = -1;
    if (Error e = OpenOnce(kShipped, &shipped)) return Fail("no walk clip; " + choice_.missing + "; " + e.message);
    choice_.shipped_walk = true;
    TakeShipped("walk");
    return Ok();
  }

  void TakeShipped(const std::string& name) {
    const int clip = NamedClip(NamesIn(choice_.shipped), name);
    if (clip >= 0) Take(name, choice_.shipped, clip);
  }

  Error ChooseOther(const ClipRequest& request) {
    const std::string& wanted = request.clip.empty() ? request.name : request.clip;
    if (!request.file.empty()) {
      int file = -1;
      if (Error e = OpenOnce(request.file, &file)) return e;
      const std::vector<std::string>& names = NamesIn(file);
      int clip = NamedClip(names, wanted);
      if (clip < 0 && request.clip.empty()) clip = names.size() == 1 ? 0 : GuessClip(names, Lower(wanted));
      if (clip < 0) {
        return Fail("no clip " + Quoted(wanted) + " in " + At(choice_.files, file).path + DidYouMean(wanted, names) +
                    " (it has: " + Listed(names) + ")");
      }
      Take(request.name, file, clip);
      return Ok();
    }
    if (!request.clip.empty()) return TakeNamed(request.name, request.clip);
    for (const int file : AllFiles()) {
      const int clip = NamedClip(NamesIn(file), wanted);
      if (clip < 0) continue;
      Take(request.name, file, clip);
      return Ok();
    }
    if (choice_.shipped_walk) TakeShipped(request.name);
    return Ok();
  }

  const GltfDocument& document_;
  const ReadAvatarOptions& options_;
  const LoneClip lone_;
  ClipChoice& choice_;
  std::vector<std::string> own_;
  std::vector<int> library_;  // of the choice's files: where all clips are looked for
};

}  // namespace

std::vector<std::string> UnusedFiles(const ReadAvatarOptions& options, const ClipChoice& choice) {
  std::vector<std::string> unused;
  for (size_t i = 0; i < choice.files.size(); ++i) {
    const MotionFile& file = choice.files[i];
    const bool asked = std::any_of(options.clip_files.begin(), options.clip_files.end(),
                                   [&](const auto& path) { return path.string() == file.path; });
    const bool used = std::any_of(choice.clips.begin(), choice.clips.end(),
                                  [&](const ChosenClip& clip) { return clip.file == static_cast<int>(i); });
    if (asked && !used)
      unused.push_back("no clip of " + file.path + " is used (it has: " + Listed(file.clip_names) +
                       "); name the one that becomes walk, idle or talk");
  }
  return unused;
}

Error ChooseClips(const GltfDocument& document, const ReadAvatarOptions& options, LoneClip lone, ClipChoice* choice) {
  return Chooser(document, options, lone, choice).Choose();
}

bool IsNoWalk(const std::string& name) {
  static constexpr std::string_view kOthers[] = {"run", "running", "jog", "jogging", "pose", "tpose", "apose"};
  return SaysMore(name) || HasAnyOf(name, kOthers) || GuessClip({name}, "idle") >= 0 || GuessClip({name}, "talk") >= 0;
}

}  // namespace flaneur
