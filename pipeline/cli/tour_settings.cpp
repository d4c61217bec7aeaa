#include "pipeline/cli/tour_settings.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "pipeline/cli/life_settings.h"
#include "runtime/base/file.h"
#include "runtime/base/text.h"
#include "runtime/base/toml_table.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

constexpr std::initializer_list<const char*> kAxes{"", "x", "y", "z", "-x", "-y", "-z"};

void ReadYaw(TomlTable* table, std::optional<float>* yaw_rad) {
  float told_rad = 0;
  table->Angle("yaw", &told_rad, -360, 360);
  if (table->Has("yaw_deg")) *yaw_rad = told_rad;
}

void ReadSource(TomlTable* table, SourceSettings* source) {
  table->File("file", &source->file);
  table->Number("seed", &source->seed, 0, 2147483647);
  table->Json("options", &source->options_json);
}

// Names become names of files.
void ReadName(TomlTable* table, std::string* name) {
  table->Text("name", name);
  const bool control = std::any_of(name->begin(), name->end(), [](char c) { return c == '/' || (c >= 0 && c < ' '); });
  if (control || name->rfind('.', 0) == 0 || name->size() > 100) {
    table->Refuse("the name '" + OneLine(*name) +
                  "' must do as a file name: no '/', no '.' in front, at most 100 letters");
  }
}

void ReadPart(TomlTable table, TourSettings* settings) {
  TownPart part;
  table.File("file", &part.file);
  table.Point("position_m", &part.position_m);
  table.Number("yaw_deg", &part.yaw_deg, -360, 360);
  table.Number("scale", &part.scale, 1e-6, 1e6);
  table.Choice("up", &part.up, kAxes);
  if (part.file.empty()) table.Refuse("a [[town.part]] needs a file");
  table.Finish();
  settings->parts.push_back(part);
}

void ReadTown(TomlTable table, TourSettings* settings) {
  ReadSource(&table, &settings->town);
  table.Number("scale", &settings->town_scale, 1e-6, 1e6);
  table.Choice("up", &settings->town_up, kAxes);
  TomlTable georeference = table.Table("georeference");
  georeference.Text("crs", &settings->georeference.crs);
  georeference.MapPoint("origin_m", &settings->georeference.origin_m.x, &settings->georeference.origin_m.y);
  georeference.Finish();
  for (TomlTable& part : table.Tables("part")) ReadPart(part, settings);
  table.Finish();
}

void ReadTint(TomlTable table, AvatarSettings* avatar) {
  Tint tint;
  table.Color("color", &tint.color);
  table.Number("reach", &tint.reach, static_cast<double>(kMinTintReach), 1);
  table.Colors("colors", &tint.colors);
  std::vector<std::string> materials;
  table.Texts("materials", &materials);
  if (!table.Has("color") || tint.colors.empty() || tint.colors.size() > kMaxTintColors) {
    table.Refuse("an [[avatar.tint]] needs the color of a cloth, and colors, one to eight, that others wear it in");
  }
  table.Finish();
  tint.by_material = !materials.empty();
  avatar->tints.push_back(std::move(tint));
  avatar->tint_materials.push_back(std::move(materials));
}

void ReadProp(TomlTable table, AvatarSettings* avatar) {
  Prop prop;
  table.Text("node", &prop.name);
  table.Number("share", &prop.share, 0, 1);
  table.Text("slot", &prop.slot);
  table.Text("clip", &prop.clip);
  if (prop.name.empty()) table.Refuse("an [[avatar.prop]] needs the node of the avatar's file that shows it");
  float of_slot = prop.share;
  for (const Prop& other : avatar->props) {
    if (other.name == prop.name) table.Refuse("two props are the node '" + OneLine(prop.name) + "'");
    if (!prop.slot.empty() && other.slot == prop.slot && other.clip == prop.clip) of_slot += other.share;
  }
  if (of_slot > 1.0001f)
    table.Refuse("the props of slot '" + OneLine(prop.slot) + "' have shares of more than 1 together");
  table.Finish();
  avatar->props.push_back(std::move(prop));
}

bool IsUsual(const std::string& clip) { return clip == "walk" || clip == "idle" || clip == "talk"; }

void ReadClip(TomlTable table, AvatarSettings* avatar) {
  ClipSettings clip;
  table.Text("name", &clip.name);
  table.Text("clip", &clip.clip);
  table.Number("seat_m", &clip.seat_m, 0, static_cast<double>(kMaxSeat_m));
  table.Number("speed_mps", &clip.speed_mps, 0, static_cast<double>(kMaxRun_mps));
  table.File("file", &clip.file);
  if (clip.file.filename() == "flaneur") clip.file = "flaneur";  // the program's own clips, in no folder
  if (clip.name.empty())
    table.Refuse("an [[avatar.clip]] needs a name: as places of work have it, or walk, idle or talk");
  if (IsUsual(clip.name) && clip.file.empty()) {
    table.Refuse("the [[avatar.clip]] '" + clip.name +
                 "' needs the file that it is in; of the avatar's own the setting " + clip.name + " names it");
  }
  std::vector<ClipSettings>* clips = IsUsual(clip.name) ? &avatar->usual_clips : &avatar->clips;
  for (const ClipSettings& other : *clips) {
    if (other.name == clip.name) table.Refuse("two clips are named '" + OneLine(clip.name) + "'");
  }
  table.Finish();
  clips->push_back(std::move(clip));
}

void ReadAvatarPart(TomlTable table, AvatarSettings* avatar) {
  std::filesystem::path file;
  table.File("file", &file);
  if (file.empty()) table.Refuse("an [[avatar.part]] needs a file");
  table.Finish();
  avatar->parts.push_back(std::move(file));
}

void ReadStance(TomlTable* table, AvatarSettings* avatar) {
  table->Number("scale", &avatar->scale, 0, 1e6);
  table->Choice("up", &avatar->up, kAxes);
  table->Choice("forward", &avatar->forward, kAxes);
  if (avatar->scale > 0 && avatar->height_m > 0) table->Refuse("an [[avatar]] has a scale or a height_m, not both");
}

void ReadAvatarSettings(TomlTable table, TourSettings* settings) {
  AvatarSettings avatar;
  ReadName(&table, &avatar.name);
  ReadSource(&table, &avatar.source);
  table.Number("share", &avatar.share, 0, 1e6);
  table.Number("height_m", &avatar.height_m, 0, 10);
  table.Number("height_spread", &avatar.height_spread, 0, static_cast<double>(kMaxHeightSpread));
  table.Number("breadth_spread", &avatar.breadth_spread, 0, static_cast<double>(kMaxBreadthSpread));
  ReadStance(&table, &avatar);
  table.Text("walk", &avatar.walk);
  table.Text("idle", &avatar.idle);
  table.Text("talk", &avatar.talk);
  table.Texts("hide", &avatar.hide);
  for (TomlTable& tint : table.Tables("tint")) ReadTint(tint, &avatar);
  for (TomlTable& prop : table.Tables("prop")) ReadProp(prop, &avatar);
  for (TomlTable& clip : table.Tables("clip")) ReadClip(clip, &avatar);
  for (TomlTable& part : table.Tables("part")) ReadAvatarPart(part, &avatar);
  if (avatar.props.size() > kMaxProps) table.Refuse("an [[avatar]] has seven [[avatar.prop]] at most");
  if (avatar.tints.size() > kMaxTints) table.Refuse("an [[avatar]] has three [[avatar.tint]] at most");
  if (avatar.source.file.empty()) table.Refuse("an [[avatar]] needs a file");
  if (avatar.name.empty()) avatar.name = avatar.source.file.stem().string();
  for (const AvatarSettings& other : settings->avatars) {
    if (other.name == avatar.name) table.Refuse("two avatars are named '" + avatar.name + "'; give each its own name");
  }
  table.Finish();
  settings->avatars.push_back(avatar);
}

void ReadLevels(TomlTable table, LevelsOptions* options) {
  table.Numbers("ratios", &options->ratios, 0.001, 1);
  table.Number("error_px", &options->error_px, 0.05, 100);
  table.Number("max_triangles", &options->max_triangles, 0, 1e8);
  table.Number("min_triangles", &options->min_triangles, 1, 1e6);
  table.Finish();
}

void ReadImpostor(TomlTable table, ImpostorOptions* options) {
  table.Number("directions", &options->directions, 1, 64);
  table.Numbers("elevations_deg", &options->elevations_deg, -89, 89);
  table.Number("height_px", &options->height_px, 16, 1024);
  table.Number("border_px", &options->border_px, 1, 16);
  table.Number("memory_kb", &options->memory_kb, 0, 1e6);
  table.Number("samples", &options->samples, 1, 4096);
  for (ImpostorClipOptions& clip : options->clips) {
    table.Number((clip.name + "_phases").c_str(), &clip.phases, 1, 256);
  }
  table.Number("work_phases", &options->work_phases, 1, 256);
  table.Finish();
}

void ReadAccepted(TomlTable table, std::vector<AcceptedFinding>* accepted) {
  AcceptedFinding finding;
  table.Number("code", &finding.code, 0, 999);
  table.MapPoint("at_m", &finding.at_m.x, &finding.at_m.y);
  table.Number("within_m", &finding.within_m, 0.01, 1e6);
  table.Text("reason", &finding.reason);
  const auto& kinds = FindingKinds();
  if (std::none_of(kinds.begin(), kinds.end(), [&](const FindingKind& k) { return k.code == finding.code; }))
    table.Refuse("footprints.accept needs the code of a finding, such as 502; docs/findings.md lists them");
  if (!table.Has("at_m")) table.Refuse("footprints.accept needs at_m = [x, y], the place of the finding");
  if (OneLine(finding.reason).empty()) table.Refuse("footprints.accept needs a reason, for who reads the report");
  table.Finish();
  accepted->push_back(std::move(finding));
}

void ReadFootprints(TomlTable table, FootprintOptions* options, GroundRasterOptions* ground,
                    std::vector<AcceptedFinding>* accepted) {
  table.Number("clearance_m", &options->clearance_m, 0, 2);
  std::vector<float> band{static_cast<float>(options->band_m[0]), static_cast<float>(options->band_m[1])};
  table.Numbers("band_m", &band, 0, 100);
  if (band.size() != 2 || band[0] >= band[1]) table.Refuse("footprints.band_m must be [low, high] in metres");
  else options->band_m = {std::round(band[0] * 1e4) / 1e4, std::round(band[1] * 1e4) / 1e4};
  table.Number("tolerance_m", &options->tolerance_m, 0, 1);
  table.Number("bridge_m", &options->bridge_m, 0, 1);
  table.Number("open_yard_m2", &options->open_yard_m2, 0, 1e6);
  table.Flag("merge_blocks", &options->merge_blocks);
  table.Number("ground_cell_m", &ground->cell_m, 0.05, 10);
  for (TomlTable& accept : table.Tables("accept")) ReadAccepted(accept, accepted);
  table.Finish();
}

// What is otherwise, or cannot be left open, at a place of play.
void ReadPlay(TomlTable& table, Place* place) {
  if (place->clip.empty()) place->clip = "run";
  if (place->people == 0) place->people = 3;
  if (!table.Has("width_m")) place->width_m = 10;
  if (place->width_m < 4 || place->width_m > kMaxPlay_m)
    table.Refuse("a [[place]] of kind \"play\" needs a width_m of 4 to 60");
}

void ReadPlace(TomlTable table, TourSettings* settings) {
  Place place;
  place.kind = "goal";
  table.Text("name", &place.name);
  table.Choice("kind", &place.kind, {"door", "exit", "goal", "loiter", "spawn", "work", "play"});
  table.TownPoint("position_m", &place.position_m);
  table.Number("width_m", &place.width_m, 0.1, 1000);
  ReadYaw(&table, &place.yaw_rad);
  table.Text("clip", &place.clip);
  table.Texts("avatars", &place.avatars);
  table.Number("seat_m", &place.seat_m, 0, static_cast<double>(kMaxSeat_m));
  table.Number("stay_s", &place.stay_s, 0, static_cast<double>(kMaxStay_s));
  table.Number("people", &place.people, 1, kMaxPlayers);
  if (!table.Has("position_m")) table.Refuse("a [[place]] needs position_m = [x, y]");
  const bool works = place.kind == "work", plays = place.kind == "play";
  for (const char* key : {"seat_m", "stay_s"}) {
    if (!works && table.Has(key)) table.Refuse(std::string(key) + " is for a [[place]] of kind \"work\"");
  }
  for (const char* key : {"clip", "avatars"}) {
    if (!works && !plays && table.Has(key))
      table.Refuse(std::string(key) + " is for a [[place]] of kind \"work\" or \"play\"");
  }
  if (!plays && table.Has("people")) table.Refuse("people is for a [[place]] of kind \"play\"");
  if (plays) ReadPlay(table, &place);
  table.Finish();
  settings->places.push_back(place);
}

void ReadPaintingSettings(TomlTable table, PaintingSettings* painting) {
  Vec2 min_m, max_m;
  table.File("file", &painting->file);
  table.TownPoint("min_m", &min_m);
  table.TownPoint("max_m", &max_m);
  table.Finish();
  if (!table.Has("min_m") && !table.Has("max_m")) return;
  if (painting->file.empty()) table.Refuse("[painting] needs a file");
  if (!(table.Has("min_m") && table.Has("max_m") && max_m.x > min_m.x && max_m.y > min_m.y)) {
    table.Refuse("[painting] needs both min_m and max_m, min_m below max_m");
  }
  painting->min_m = min_m;
  painting->max_m = max_m;
}

void ReadStop(TomlTable table, TourSettings* settings) {
  TourStop stop;
  table.TownPoint("position_m", &stop.position_m);
  ReadYaw(&table, &stop.yaw_rad);
  table.Number("pause_s", &stop.pause_s, 0, 3600);
  table.Translations("caption", settings->language, &stop.captions);
  if (const auto own = stop.captions.find(settings->language); own != stop.captions.end()) {
    stop.caption = own->second;
    stop.captions.erase(own);
  } else if (!stop.captions.empty()) {
    table.Refuse("the caption has no text in the tour's own language, '" + settings->language +
                 "'; add one, or change tour.language");
  }
  settings->sounds.push_back(ReadFiles("sound", settings->language, &table));
  bool speak = false;
  table.Flag("speak", &speak);
  settings->visitor_files.stops_speak.push_back(speak);
  if (!table.Has("position_m")) table.Refuse("a [[stop]] needs position_m = [x, y]");
  table.Finish();
  settings->path.push_back(stop);
}

void ReadAll(TomlTable root, TourSettings* settings) {
  TomlTable tour = root.Table("tour");
  ReadName(&tour, &settings->name);
  tour.Text("language", &settings->language);
  if (settings->language.empty()) tour.Refuse("tour.language must not be empty; such as \"en\"");
  tour.Translations("title", settings->language, &settings->titles);
  std::erase_if(settings->titles, [](const auto& title) { return title.second.empty(); });
  if (!settings->titles.empty() && !settings->titles.contains(settings->language)) {
    tour.Refuse("tour.title has no text in the tour's own language, '" + settings->language +
                "'; add one, or change tour.language");
  }
  tour.Text("guide", &settings->guide);
  tour.Translations("thanks", settings->language, &settings->thanks);
  std::erase_if(settings->thanks, [](const auto& thanks) { return thanks.second.empty(); });
  tour.Number("home_after_s", &settings->home_after_s, 0, kLongestIdle_s);
  tour.Finish();
  ReadTown(root.Table("town"), settings);
  for (TomlTable& avatar : root.Tables("avatar", kMostAvatars)) ReadAvatarSettings(avatar, settings);
  ReadLevels(root.Table("levels"), &settings->levels);
  ReadImpostor(root.Table("impostor"), &settings->impostor);
  ReadFootprints(root.Table("footprints"), &settings->footprints, &settings->ground, &settings->accepted);
  for (TomlTable& place : root.Tables("place")) ReadPlace(place, settings);
  for (TomlTable& stop : root.Tables("stop", kMostStops)) ReadStop(stop, settings);
  ReadVisitorSettings(&root, settings, &settings->visitor_files);
  ReadLifeSettings(&root, settings);
  ReadPaintingSettings(root.Table("painting"), &settings->painting_file);
  ReadTitlePageSettings(root.Table("title_page"), &settings->title_page);
  const auto section = [&](const char* name, auto* values) {
    TomlTable table = root.Table(name);
    VisitFields(table, values);
    table.Finish();
  };
  section("crowd", &settings->crowd);
  section("control", &settings->control);
  section("light", &settings->light);
  section("wind", &settings->wind);
  root.Finish();
}

void CheckWhole(TomlContext* context, const TourSettings& s) {
  const auto refuse = [&](const std::string& why) { context->Refuse(nullptr, why); };
  if (s.town.file.empty() && s.parts.empty()) refuse("no town: give [town] a file, or [[town.part]]s");
  if (s.avatars.empty()) refuse("nobody to populate the town: add an [[avatar]] with a file");
  const auto is_guide = [&](const AvatarSettings& a) { return a.name == s.guide; };
  if (!s.guide.empty() && std::none_of(s.avatars.begin(), s.avatars.end(), is_guide)) {
    refuse("tour.guide is '" + OneLine(s.guide) + "', but no [[avatar]] has that name");
  }
  for (const Place& place : s.places) {
    for (const std::string& name : place.avatars) {
      const auto is_named = [&](const AvatarSettings& a) { return a.name == name; };
      if (std::none_of(s.avatars.begin(), s.avatars.end(), is_named))
        refuse("place '" + OneLine(place.name) + "': no [[avatar]] has the name '" + OneLine(name) + "'");
    }
  }
  for (const Flock& flock : s.flocks) {
    const auto is_named = [&](const AvatarSettings& a) { return a.name == flock.avatar; };
    if (std::none_of(s.avatars.begin(), s.avatars.end(), is_named))
      refuse("a [[flock]] is of '" + OneLine(flock.avatar) + "', but no [[avatar]] has that name");
  }
  const ControlSettings& c = s.control;
  const std::pair<const char*, float> radii[] = {{"r_personal_m", c.r_personal_m},
                                                 {"r_high_m", c.r_high_m},
                                                 {"r_unimportant_m", c.r_unimportant_m},
                                                 {"r_far_m", c.r_far_m}};
  for (size_t i = 0; i + 1 < std::size(radii); ++i) {
    const auto& [inner, inner_m] = radii[i];
    const auto& [outer, outer_m] = radii[i + 1];
    if (!(inner_m < outer_m))
      refuse(std::string("control: ") + inner + " (" + Compact(static_cast<double>(inner_m)) + ") must be below " +
             outer + " (" + Compact(static_cast<double>(outer_m)) + ")");
  }
  if (s.crowd.preferred_speed_mps > s.crowd.top_speed_mps) {
    refuse("crowd: preferred_speed_mps must not be above top_speed_mps");
  }
}

}  // namespace

Error ReadTourSettings(const std::filesystem::path& path, TourSettings* settings) {
  toml::table root;
  if (Error e = ReadToml(path, &root)) return e;
  TomlContext context{path, {}, {}, {}};
  TourSettings read;
  read.name = path.stem().string() == "tour" ? std::filesystem::absolute(path).parent_path().filename().string()
                                             : path.stem().string();
  ReadAll(TomlTable(&context, &root, ""), &read);
  CheckWhole(&context, read);
  if (context.error) return context.error;
  for (const auto& [file, place] : context.files) read.places_of_files.try_emplace(file, place);
  *settings = std::move(read);
  return Ok();
}

std::string PlaceOfFile(const TourSettings& settings, const std::filesystem::path& file) {
  const auto place = settings.places_of_files.find(file);
  return place == settings.places_of_files.end() ? "" : place->second + ": ";
}

std::string PlaceOfMessage(const TourSettings& settings, std::string_view message) {
  const auto& places = settings.places_of_files;
  const auto is_named = [&](const auto& entry) { return message.starts_with(entry.first.string() + ": "); };
  std::string found;
  for (auto it = std::find_if(places.begin(), places.end(), is_named); it != places.end();
       it = std::find_if(places.begin(), places.end(), is_named)) {
    found = it->second + ": ";
    message.remove_prefix(it->first.string().size() + 2);
  }
  return found;
}

std::vector<std::string> KnownSettings() {
  // One empty table of each kind makes every field be asked for.
  const toml::table root = toml::parse(
      "[[avatar]]\n[[avatar.tint]]\n[[avatar.prop]]\n[[avatar.clip]]\n[[avatar.part]]\n[[place]]\n[[stop]]\n[[town."
      "part]]\n"
      "[[hotspot]]\n[[street]]\n[[sound]]\n[[flock]]\n[[smoke]]\n[[footprints.accept]]\n");
  TomlContext context;
  TourSettings settings;
  ReadAll(TomlTable(&context, &root, ""), &settings);
  const std::set<std::string> unique(context.known.begin(), context.known.end());
  return {unique.begin(), unique.end()};
}

}  // namespace flaneur
