#include "runtime/visit/player_settings.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/base/toml_text.h"
#include "runtime/visit/settings_text.h"
#include "runtime/visit/window_input.h"

namespace flaneur {
namespace {

// visit.Number(name, value, least, most, about), and the like for the other kinds.
template <typename Settings, typename Visit>
void VisitSettings(Settings* s, Visit visit) {
  visit.Text("language", &s->language,
             "of the guided tour's captions and sounds, such as \"de\"; \"\": the tour's own");
  visit.Choice("pointer", &s->pointer, {"look", "point"},
               "look: the mouse turns the view; point: drag to turn, click to walk there");
  visit.Number("walk_speed_mps", &s->walk_speed_mps, 0.3, 3, "at most; a crowd slows you down");
  visit.Number("turn_speed_dps", &s->turn_speed_dps, 10, 360, "of turning by keys and gamepad");
  visit.Number("mouse_speed", &s->mouse_speed, 0.1, 10, "of turning by mouse, relative to the usual");
  visit.Number("field_of_view_deg", &s->field_of_view_deg, 0, 120,
               "from left to right, 30 to 120; 0: as the tour says");
  visit.Number("snap_turn_deg", &s->snap_turn_deg, 0, 90, "keys and gamepad turn by so much at a time; 0: smoothly");
  visit.Flag("invert_look", &s->invert_look, "pushing the mouse or stick up looks down");
  visit.Choice("text_size", &s->text_size, {"normal", "large", "largest"}, "of pages and captions");
  visit.Flag("high_contrast", &s->high_contrast, "pages and captions are white and yellow on black");
  visit.Flag("captions_always", &s->captions_always, "nothing takes the place of a caption while it is due");
  visit.Number("pace", &s->pace, 0.3, 1.5, "of you and of the tour, and how long it lets you read; 1: the usual");
  visit.Number("eye_height_m", &s->eye_height_m, 0, 2.2,
               "above the ground, from 0.5; 1.2 as if seated; 0: as the tour has it");
  visit.Choice("one_handed", &s->one_handed, {"off", "left_keys", "right_keys", "left_pad", "right_pad"},
               "that half of the keyboard or gamepad does everything");
  visit.Flag("reduced_motion", &s->reduced_motion,
             "you turn in steps, the tour turns the view gently and walks slowly, and jumps fade");
  visit.Number("sound_volume", &s->sound_volume, 0, 1, "of all sounds; 1: as recorded");
  visit.Number("frames_per_s", &s->frames_per_s, 5, 240,
               "wished for: a machine that draws fewer draws more coarsely instead");
  visit.Number("least_resolution_scale", &s->least_resolution_scale, 0.25, 1,
               "as coarsely as that, of width and height; 1: never");
  visit.Flag("fullscreen", &s->fullscreen, "the window fills its screen");
  visit.Text("photos", &s->photos, "folder of visitors' photos; \"\": in your own pictures, in an exhibition none");
  visit.Text("photo_link", &s->photo_link, "for the photos' QR code, with {file} or {id}; \"\": the tour's own");
  visit.Number("photos_most", &s->photos_most, 1, 100000, "photos are kept; of more the eldest are deleted");
  visit.Flag("kiosk", &s->kiosk, "for exhibitions: visitor after visitor, and only the operator ends it");
}

std::vector<std::string> KnownNames() {
  struct Names {
    std::vector<std::string>* out;
    void Text(const char* name, const std::string*, const char*) const { out->push_back(name); }
    void Choice(const char* name, const std::string*, std::initializer_list<const char*>, const char*) const {
      out->push_back(name);
    }
    void Number(const char* name, const float*, double, double, const char*) const { out->push_back(name); }
    void Flag(const char* name, const bool*, const char*) const { out->push_back(name); }
  };
  std::vector<std::string> names;
  const PlayerSettings settings;
  VisitSettings(&settings, Names{&names});
  for (const char* action : kActionNames) names.push_back(std::string("keys.") + action);
  return names;
}

// Where all but the keys stands.
struct Fields {
  std::vector<std::string*> texts;
  std::vector<float*> numbers;
  std::vector<bool*> flags;
};

Fields FieldsOf(PlayerSettings* settings) {
  struct Finder {
    Fields* out;
    void Text(const char*, std::string* value, const char*) const { out->texts.push_back(value); }
    void Choice(const char*, std::string* value, std::initializer_list<const char*>, const char*) const {
      out->texts.push_back(value);
    }
    void Number(const char*, float* value, double, double, const char*) const { out->numbers.push_back(value); }
    void Flag(const char*, bool* value, const char*) const { out->flags.push_back(value); }
  };
  Fields fields;
  VisitSettings(settings, Finder{&fields});
  return fields;
}

// Takes one value; says what is wrong with it.
struct Taker {
  std::string name;
  const toml::node* node;
  std::string* wrong;
  bool* known;

  bool IsIt(const char* setting) const {
    if (name != setting) return false;
    *known = true;
    return true;
  }
  void Text(const char* setting, std::string* value, const char*) const {
    if (!IsIt(setting)) return;
    if (node->is_string()) *value = *node->value<std::string>();
    else *wrong = "must be text in quotes";
  }
  void Choice(const char* setting, std::string* value, std::initializer_list<const char*> allowed, const char*) const {
    if (!IsIt(setting)) return;
    const std::string text = node->value<std::string>().value_or("");
    std::string list;
    for (const char* a : allowed) {
      if (text == a) *value = text;
      list += (list.empty() ? "" : " or ") + std::string(a);
    }
    if (*value != text) *wrong = "must be " + list;
  }
  void Number(const char* setting, float* value, double least, double most, const char*) const {
    if (!IsIt(setting)) return;
    const auto number = node->is_number() ? node->value<double>() : std::nullopt;
    if (number && *number >= least && *number <= most) *value = static_cast<float>(*number);
    else *wrong = "must be a number from " + Compact(least) + " to " + Compact(most);
  }
  void Flag(const char* setting, bool* value, const char*) const {
    if (!IsIt(setting)) return;
    if (node->is_boolean()) *value = *node->value<bool>();
    else *wrong = "must be true or false";
  }
};

std::string TakeKeys(const toml::node& node, std::vector<std::string>* keys) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return "must be a list of keys, such as [\"w\", \"up\"]";
  std::vector<std::string> taken;
  for (const toml::node& element : *array) {
    const std::string key = element.value<std::string>().value_or("");
    if (InputCode(key) < 0)
      return "names the key '" + OneLine(key) + "', which there is not" + DidYouMean(key, InputNames());
    taken.push_back(key);
  }
  *keys = std::move(taken);
  return "";
}

// What is wrong; empty: nothing.
std::string Take(const std::string& name, const toml::node& node, PlayerSettings* s) {
  for (size_t k = 0; k < kActions; ++k) {
    if (name == std::string("keys.") + kActionNames[k]) return TakeKeys(node, &s->keys[k]);
  }
  std::string wrong;
  bool known = false;
  VisitSettings(s, Taker{name, &node, &wrong, &known});
  return known ? wrong : "is no setting" + DidYouMean(name, KnownNames());
}

std::string Quoted(const std::string& text) {
  std::ostringstream out;
  const toml::value<std::string> value(text);
  out << toml::toml_formatter(value, toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings);
  return out.str();
}

struct Writer {
  std::string* out;
  void Line(const char* name, const std::string& value, const char* about) const {
    std::string line = std::string(name) + " = " + value;
    line.resize(std::max(line.size() + 1, size_t{28}), ' ');
    *out += line + "# " + about + "\n";
  }
  void Text(const char* name, const std::string* value, const char* about) const { Line(name, Quoted(*value), about); }
  void Choice(const char* name, const std::string* value, std::initializer_list<const char*>, const char* about) const {
    Line(name, Quoted(*value), about);
  }
  void Number(const char* name, const float* value, double, double, const char* about) const {
    Line(name, Compact(static_cast<double>(*value)), about);
  }
  void Flag(const char* name, const bool* value, const char* about) const {
    Line(name, *value ? "true" : "false", about);
  }
};

}  // namespace

PlayerSettings::PlayerSettings()
    : keys{{{"w", "up"},
            {"s", "down"},
            {"a"},
            {"d"},
            {"left", "q"},
            {"right", "e"},
            {"r"},
            {"f"},
            {"tab", "pad_y"},
            {"space", "pad_a"},
            {"n", "page_down", "pad_right_bumper"},
            {"b", "page_up", "pad_left_bumper"},
            {"l", "pad_x"},
            {"m"},
            {"minus", "keypad_subtract"},
            {"equal", "keypad_add"},
            {"f1"},
            {"f2"},
            {"f11"},
            {"t", "pad_back"},
            {"p", "pad_down"},
            {"i", "enter", "pad_up"},
            {"escape", "pad_start", "mouse_right"},
            {"f10"}}} {}

std::filesystem::path PlayerSettingsPath() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  // The base directory specification has relative paths ignored.
  if (config != nullptr && config[0] == '/') return std::filesystem::path(config) / "flaneur" / "player.toml";
  if (home != nullptr && home[0] == '/') return std::filesystem::path(home) / ".config" / "flaneur" / "player.toml";
  return {};
}

Error ReadPlayerSettings(const std::filesystem::path& path, PlayerSettings* settings,
                         std::vector<std::string>* warnings) {
  std::error_code ec;
  std::string text;
  if (path.empty() || !std::filesystem::exists(path, ec)) return Ok();
  if (Error e = ReadTextFile(path, &text)) return e;
  return TakePlayerSettings(text, path.string(), settings, warnings);
}

Error TakePlayerSettings(const std::string& text, const std::string& name, PlayerSettings* settings,
                         std::vector<std::string>* warnings) {
  toml::table root;
  if (Error e = ParseToml(text, name, &root)) return e;
  const auto take = [&](const std::string& setting, const toml::node& node) {
    const std::string wrong = Take(setting, node, settings);
    if (wrong.empty()) return;
    warnings->push_back(name + ":" + std::to_string(node.source().begin.line) + ": " + OneLine(setting) + " " + wrong);
  };
  for (const auto& [key, node] : root) {
    const toml::table* table = node.as_table();
    if (table == nullptr || key.str() != "keys") take(std::string(key.str()), node);
    else
      for (const auto& [action, keys] : *table) take("keys." + std::string(action.str()), keys);
  }
  return Ok();
}

Error SetPlayerSetting(const std::string& assignment, PlayerSettings* settings) {
  const size_t equal = assignment.find('=');
  if (equal == std::string::npos) return Fail("'" + OneLine(assignment) + "' must be SETTING=VALUE");
  const std::string name = assignment.substr(0, equal), value = assignment.substr(equal + 1);
  toml::table parsed;
  if (name.rfind("keys.", 0) == 0) {
    toml::array keys;
    std::istringstream list(value);
    for (std::string key; std::getline(list, key, ',');) keys.push_back(key);
    parsed.insert("value", keys);
  } else {
    try {
      parsed = toml::parse("value = " + value);
    } catch (const toml::parse_error&) {
      parsed.insert("value", value);
    }
  }
  const std::string wrong = parsed.contains("value") ? Take(name, *parsed.get("value"), settings) : "needs a value";
  return wrong.empty() ? Ok() : Fail(OneLine(name) + " " + wrong);
}

void KeepChanges(const PlayerSettings& before, const PlayerSettings& now, PlayerSettings* kept) {
  PlayerSettings was = before, is = now;
  const Fields old = FieldsOf(&was), fresh = FieldsOf(&is), target = FieldsOf(kept);
  const auto keep = [](const auto& from, const auto& to, const auto& out) {
    for (size_t k = 0; k < to.size(); ++k) {
      if (*from[k] != *to[k]) *out[k] = *to[k];
    }
  };
  keep(old.texts, fresh.texts, target.texts);
  keep(old.numbers, fresh.numbers, target.numbers);
  keep(old.flags, fresh.flags, target.flags);
  for (size_t k = 0; k < kActions; ++k) {
    if (was.keys[k] != is.keys[k]) kept->keys[k] = is.keys[k];
  }
}

std::string PlayerSettingsText(const PlayerSettings& settings) {
  std::string out = "# How you walk and look in flaneur-player. Delete a line to have its default.\n";
  VisitSettings(&settings, Writer{&out});
  out += "\n# Each with any number of keys and gamepad buttons; docs/player.md lists their names.\n[keys]\n";
  for (size_t k = 0; k < kActions; ++k) {
    std::string list;
    for (const std::string& key : settings.keys[k]) list += (list.empty() ? "" : ", ") + Quoted(key);
    out += std::string(kActionNames[k]) + " = [" + list + "]\n";
  }
  return out;
}

Error WritePlayerSettings(const std::filesystem::path& path, const PlayerSettings& settings) {
  return WriteTextFile(path, PlayerSettingsText(settings));
}

}  // namespace flaneur
