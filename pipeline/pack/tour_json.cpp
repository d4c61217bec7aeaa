#include "pipeline/pack/tour_json.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "runtime/base/array.h"
#include "runtime/base/color_text.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

using Json = nlohmann::ordered_json;

// The shortest decimal that reads back as the same float.
double Short(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", static_cast<double>(value));
  return std::atof(text);
}

double Millimetres(double metres) { return std::round(metres * 1e4) / 1e4; }

Json PointJson(const Point2& p) { return {Millimetres(p.x), Millimetres(p.y)}; }
Json PointJson(const Vec2& p) { return {Short(p.x), Short(p.y)}; }

template <typename Points>
Json PointsJson(const Points& points) {
  Json out = Json::array();
  for (const auto& p : points) out.push_back(PointJson(p));
  return out;
}

struct SettingsWriter {
  Json* json;
  template <typename T>
  void Number(const char* name, T* value, double, double) const {
    if constexpr (std::is_integral_v<T>) (*json)[name] = *value;
    else (*json)[name] = Short(*value);
  }
  void Angle(const char* stem, float* radians, double, double) const {
    (*json)[std::string(stem) + "_rad"] = Short(*radians);
  }
  void Choice(const char* name, std::string* value, std::initializer_list<const char*>) const {
    (*json)[name] = *value;
  }
};

template <typename Settings>
Json SettingsJson(Settings settings) {
  Json json = Json::object();
  VisitFields(SettingsWriter{&json}, &settings);
  return json;
}

constexpr const char* kUsualClips[] = {"walk", "idle", "talk"};

bool IsUsual(const std::string& clip) {
  return std::find(std::begin(kUsualClips), std::end(kUsualClips), clip) != std::end(kUsualClips);
}

Json ImpostorJson(const ImpostorAtlas& atlas, const ImpostorViews& views) {
  Json clips = Json::array(), elevations = Json::array();
  Json others = Json::array();
  for (const ImpostorClip& clip : atlas.clips) {
    (IsUsual(clip.name) ? clips : others)
        .push_back({{"name", clip.name}, {"first_frame", clip.first_frame}, {"phases", clip.phases}});
  }
  for (float e : atlas.elevations_deg) elevations.push_back(Short(e));
  Json json{{"directions", atlas.directions},
            {"elevations_deg", elevations},
            {"frames", atlas.frames},
            {"width_px", atlas.width_px},
            {"height_px", atlas.height_px},
            {"texel_m", Short(atlas.texel_m)},
            {"depth_range_m", Short(atlas.depth_range_m)},
            {"motion_range_m", Short(atlas.motion_range_m)},
            {"bend_range_m", Short(atlas.bend_range_m)},
            {"clips", clips},
            {"cells_view", views.cells},
            {"albedo_view", views.albedo},
            {"normal_view", views.normal},
            {"depth_view", views.depth},
            {"motion_view", views.motion}};
  if (views.tints >= 0) json["tints_view"] = views.tints;
  if (!others.empty()) json["other_clips"] = others;
  return json;
}

// Of the t-th tint, with the materials that it may dye where it may not dye all.
Json TintJson(const Tint& tint, size_t t, const std::vector<Material>& materials, const AvatarPart& part) {
  Json colors = Json::array();
  for (Vec3 color : tint.colors) colors.push_back(TextFromColor(color));
  Json json{{"color", TextFromColor(tint.color)}, {"reach", Short(tint.reach)}, {"colors", colors}};
  std::vector<int> dyed;
  for (size_t m = 0; m < materials.size(); ++m) {
    if (materials[m].tints >> t & 1) dyed.push_back(part.materials[m]);
  }
  if (dyed.size() < materials.size()) json["materials"] = dyed;
  return json;
}

Json OtherClipJson(const std::string& name, int animation, const std::vector<TourClip>& known) {
  Json json{{"name", name}, {"animation", animation}};
  for (const TourClip& clip : known) {
    if (clip.name == name && clip.seat_m > 0) json["seat_m"] = Short(clip.seat_m);
    if (clip.name == name && clip.speed_mps > 0) json["speed_mps"] = Short(clip.speed_mps);
  }
  return json;
}

Json AvatarJson(const TourAvatar& avatar, const AvatarPart& part, const ImpostorViews& views) {
  const Avatar& person = avatar.levels.avatar;
  Json levels = Json::array(), clips = Json::object(), others = Json::array();
  for (size_t i = 0; i < avatar.levels.levels.size(); ++i) {
    const AvatarLevel& level = avatar.levels.levels[i];
    levels.push_back({{"node", part.level_nodes[i]},
                      {"triangles", level.triangles},
                      {"error_mm", Short(level.error_mm)},
                      {"posed_error_mm", Short(level.posed_error_mm)},
                      {"switch_px", Short(level.switch_px)}});
  }
  for (size_t c = 0; c < person.clips.size(); ++c) {
    const std::string& name = person.clips[c].name;
    if (IsUsual(name)) clips[name] = part.animations[c];
    else others.push_back(OtherClipJson(name, part.animations[c], avatar.clips));
  }
  Json json{{"name", person.name},
            {"share", Short(avatar.share)},
            {"height_m", Short(person.height_m)},
            {"radius_m", Short(person.radius_m)},
            {"reach_m", Short(avatar.reach_m)},
            {"walk_speed_mps", Short(person.walk_speed_mps)},
            {"clips", clips},
            {"levels", levels},
            {"impostor", ImpostorJson(avatar.impostor, views)}};
  if (!others.empty()) json["other_clips"] = others;
  if (avatar.height_spread > 0) json["height_spread"] = Short(avatar.height_spread);
  if (avatar.breadth_spread > 0) json["breadth_spread"] = Short(avatar.breadth_spread);
  for (size_t t = 0; t < avatar.tints.size(); ++t)
    json["tints"].push_back(TintJson(avatar.tints[t], t, person.materials, part));
  for (size_t k = 0; k < person.props.size(); ++k) {
    json["props"].push_back({{"name", person.props[k].name},
                             {"node", part.prop_nodes[k]},
                             {"triangles", avatar.prop_triangles[k]},
                             {"share", Short(avatar.props[k].share)},
                             {"slot", avatar.props[k].slot}});
    if (!avatar.props[k].clip.empty()) json["props"].back()["clip"] = avatar.props[k].clip;
  }
  return json;
}

Json ObstacleJson(const Obstacle& obstacle) {
  Json json{{"name", obstacle.name}, {"kind", ObstacleKindName(obstacle.kind)}};
  if (obstacle.outer.empty()) {
    json["center_m"] = PointJson(obstacle.center);
    json["radius_m"] = Millimetres(obstacle.radius_m);
    return json;
  }
  json["outer_m"] = PointsJson(obstacle.outer);
  if (!obstacle.holes.empty()) {
    json["holes_m"] = Json::array();
    for (const auto& hole : obstacle.holes) json["holes_m"].push_back(PointsJson(hole));
  }
  return json;
}

Json SoundJson(const StopSound& sound, const TourIndices& indices) {
  return {{"view", At(indices.sounds, sound.sound)}, {"duration_s", Short(sound.duration_s)}};
}

Json WorkJson(const Place& place) {
  Json json{
      {"name", place.name}, {"position_m", PointJson(place.position_m)}, {"yaw_rad", Short(place.yaw_rad.value_or(0))}};
  if (!place.clip.empty()) json["clip"] = place.clip;
  if (!place.avatars.empty()) json["avatars"] = place.avatars;
  if (place.seat_m > 0) json["seat_m"] = Short(place.seat_m);
  if (place.stay_s > 0) json["stay_s"] = Short(place.stay_s);
  return json;
}

Json PlayJson(const Place& place) {
  Json json{{"name", place.name},
            {"position_m", PointJson(place.position_m)},
            {"width_m", Short(place.width_m)},
            {"clip", place.clip},
            {"people", place.people}};
  if (!place.avatars.empty()) json["avatars"] = place.avatars;
  return json;
}

Json StopJson(const TourStop& stop, const TourIndices& indices) {
  Json json{{"position_m", PointJson(stop.position_m)}, {"pause_s", Short(stop.pause_s)}, {"caption", stop.caption}};
  if (stop.yaw_rad) json["yaw_rad"] = Short(*stop.yaw_rad);
  for (const auto& [language, caption] : stop.captions) json["captions"][language] = caption;
  for (const auto& [language, sound] : stop.sounds) {
    json["sounds"][language] = SoundJson(sound, indices);
  }
  return json;
}

Json TitlePageJson(const TitlePage& page, const TourIndices& indices) {
  Json json{{"background", TextFromColor(page.background)}};
  if (indices.title_picture_view >= 0) json["picture_view"] = indices.title_picture_view;
  if (indices.title_logo_view >= 0) json["logo_view"] = indices.title_logo_view;
  return json;
}

Json HotspotJson(const Hotspot& hotspot, const TourIndices& indices) {
  Json json{{"position_m", PointJson(hotspot.position_m)},
            {"height_m", Short(hotspot.height_m)},
            {"radius_m", Short(hotspot.radius_m)}};
  for (const auto& [language, title] : hotspot.titles) json["titles"][language] = title;
  for (const auto& [language, text] : hotspot.texts) json["texts"][language] = text;
  if (hotspot.picture >= 0) json["picture_view"] = At(indices.pictures, hotspot.picture);
  for (const auto& [language, sound] : hotspot.sounds) json["sounds"][language] = SoundJson(sound, indices);
  return json;
}

Json SoundPlaceJson(const SoundPlace& place, const TourIndices& indices) {
  Json json{{"kind", kSoundKindNames[static_cast<size_t>(place.kind)]},
            {"position_m", PointJson(place.position_m)},
            {"height_m", Short(place.height_m)},
            {"radius_m", Short(place.radius_m)},
            {"volume", Short(place.volume)}};
  if (place.sound >= 0) json["view"] = At(indices.sounds, place.sound);
  return json;
}

Json FlockJson(const Flock& flock) {
  return {{"avatar", flock.avatar},
          {"position_m", PointJson(flock.position_m)},
          {"radius_m", Short(flock.radius_m)},
          {"birds", flock.birds},
          {"shy_m", Short(flock.shy_m)},
          {"clip", flock.clip}};
}

Json SmokeJson(const Smoke& smoke) {
  const Vec3 p = smoke.position_m;
  return {{"position_m", {Short(p.x), Short(p.y), Short(p.z)}},
          {"width_m", Short(smoke.width_m)},
          {"density", Short(smoke.density)}};
}

// What there is for visitors; nothing where there is nothing.
void AddVisitorJson(const TourParts& parts, const TourIndices& indices, Json* tour) {
  for (const Hotspot& hotspot : parts.hotspots) (*tour)["hotspots"].push_back(HotspotJson(hotspot, indices));
  for (const Street& street : parts.streets) {
    Json json{{"points_m", PointsJson(street.points)}};
    for (const auto& [language, name] : street.names) json["names"][language] = name;
    (*tour)["streets"].push_back(std::move(json));
  }
  for (const SoundPlace& place : parts.sound_places) (*tour)["sounds"].push_back(SoundPlaceJson(place, indices));
  for (const auto& [language, line] : parts.photo.lines) (*tour)["photo"]["lines"][language] = line;
  if (!parts.photo.link.empty()) (*tour)["photo"]["link"] = parts.photo.link;
}

}  // namespace

std::string TourJson(const TourParts& parts, const TourIndices& indices) {
  Json tour{{"version", kTourPackVersion}, {"name", parts.name}};
  tour["avatars"] = Json::array();
  for (size_t i = 0; i < parts.avatars.size(); ++i) {
    tour["avatars"].push_back(AvatarJson(parts.avatars[i], indices.avatars[i], indices.impostors[i]));
  }
  tour["obstacles"] = Json::array();
  for (const Obstacle& o : parts.footprints.obstacles) tour["obstacles"].push_back(ObstacleJson(o));
  tour["ground"] = {{"min_m", PointJson(parts.ground.min_m)}, {"cell_m", Short(parts.ground.cell_m)},
                    {"columns", parts.ground.columns},        {"rows", parts.ground.rows},
                    {"height_view", indices.height_view},     {"kind_view", indices.kind_view}};
  tour["places"] = Json::array();
  for (const Place& p : parts.places) {
    if (p.kind == "work") {
      tour["work"].push_back(WorkJson(p));
      continue;
    }
    if (p.kind == "play") {
      tour["play"].push_back(PlayJson(p));
      continue;
    }
    tour["places"].push_back(
        {{"name", p.name}, {"kind", p.kind}, {"position_m", PointJson(p.position_m)}, {"width_m", Short(p.width_m)}});
    if (p.yaw_rad) tour["places"].back()["yaw_rad"] = Short(*p.yaw_rad);
  }
  if (indices.people_view >= 0) {
    const Painting& p = parts.painting;
    tour["painting"] = {{"min_m", PointJson(p.min_m)},
                        {"cell_m", Short(p.cell_m)},
                        {"columns", p.columns},
                        {"rows", p.rows},
                        {"people_view", indices.people_view},
                        {"loiter_view", indices.loiter_view}};
  }
  tour["path"] = Json::array();
  for (const TourStop& s : parts.path) tour["path"].push_back(StopJson(s, indices));
  for (const auto& [language, title] : parts.titles) tour["titles"][language] = title;
  tour["language"] = parts.language;
  if (!parts.guide.empty()) tour["guide"] = parts.guide;
  if (indices.title_picture_view >= 0 || indices.title_logo_view >= 0)
    tour["title_page"] = TitlePageJson(parts.title_page, indices);
  AddVisitorJson(parts, indices, &tour);
  for (const Flock& flock : parts.flocks) tour["flocks"].push_back(FlockJson(flock));
  for (const Smoke& smoke : parts.smokes) tour["smokes"].push_back(SmokeJson(smoke));
  for (const auto& [language, thanks] : parts.thanks) tour["thanks"][language] = thanks;
  tour["home_after_s"] = Short(parts.home_after_s);
  tour["crowd"] = SettingsJson(parts.crowd);
  tour["control"] = SettingsJson(parts.control);
  tour["light"] = SettingsJson(parts.light);
  tour["wind"] = SettingsJson(parts.wind);
  return tour.dump();
}

}  // namespace flaneur
