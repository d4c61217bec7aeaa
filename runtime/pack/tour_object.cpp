#include "runtime/pack/tour_object.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/color_text.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

[[noreturn]] void RefuseMember(const std::string& place, const std::string& why) {
  throw PackRefused("is broken: " + place + " " + why);
}

std::string RangeText(double least, double most) {
  const std::string low = least <= -TourObject::kAnything   ? ""
                          : least == TourObject::kAboveZero ? "above 0"
                                                            : "at least " + Compact(least);
  const std::string high = most >= TourObject::kAnything ? "" : "at most " + Compact(most);
  return low + (low.empty() || high.empty() ? "" : " and ") + high;
}

std::string Item(const std::string& place, size_t index) { return place + "[" + std::to_string(index) + "]"; }

}  // namespace

TourObject::TourObject(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
  if (!json_.is_object()) RefuseMember(place_, "must be an object");
}

void TourObject::Refuse(const std::string& why) const { RefuseMember(place_, why); }

const Json& TourObject::Get(const char* key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) RefuseMember(Place(key), "is missing");
  return *found;
}

const Json& TourObject::Array(const char* key) const {
  const Json& json = Get(key);
  if (!json.is_array()) RefuseMember(Place(key), "must be a list");
  return json;
}

double TourObject::Checked(const Json& json, const std::string& place, bool whole, double least, double most) {
  if (!json.is_number()) RefuseMember(place, "must be a number");
  const double number = json.get<double>();
  if (!std::isfinite(number) || (whole && number != std::floor(number))) {
    RefuseMember(place, std::string("must be a ") + (whole ? "whole" : "finite") + " number");
  }
  if (number < least || number > most)
    RefuseMember(place, "is " + Compact(number) + ", it must be " + RangeText(least, most));
  return number;
}

Vec2 TourObject::CheckedPoint(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() != 2) RefuseMember(place, "must be [x, y]");
  return {static_cast<float>(Checked(json[0], Item(place, 0), false, -kMostCoordinate_m, kMostCoordinate_m)),
          static_cast<float>(Checked(json[1], Item(place, 1), false, -kMostCoordinate_m, kMostCoordinate_m))};
}

std::vector<Vec2> TourObject::CheckedRing(const Json& json, const std::string& place) {
  if (!json.is_array() || json.size() < 3) RefuseMember(place, "must be a list of three points or more");
  std::vector<Vec2> points;
  for (size_t i = 0; i < json.size(); ++i) points.push_back(CheckedPoint(json[i], Item(place, i)));
  return points;
}

std::vector<std::string> TourObject::Keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, unused] : json_.items()) keys.push_back(key);
  return keys;
}

float TourObject::Real(const char* key, double least, double most) const {
  return static_cast<float>(Checked(Get(key), Place(key), false, least, most));
}

int TourObject::Whole(const char* key, double least, double most) const {
  return static_cast<int>(Checked(Get(key), Place(key), true, least, most));
}

float TourObject::Yaw(const char* key) const {
  constexpr double kTurn_rad = 2 * static_cast<double>(kPi);
  return static_cast<float>(
      std::remainder(Checked(Get(key), Place(key), false, -kMostYaw_rad, kMostYaw_rad), kTurn_rad));
}

std::string TourObject::Text(const char* key, size_t most_bytes) const {
  const Json& json = Get(key);
  if (!json.is_string()) RefuseMember(Place(key), "must be text");
  const auto& text = json.get_ref<const std::string&>();
  if (text.size() > most_bytes)
    RefuseMember(Place(key), "is text of more than " + std::to_string(most_bytes) + " bytes");
  return text;
}

std::vector<std::string> TourObject::Texts(const char* key) const {
  const Json& json = Array(key);
  std::vector<std::string> texts;
  for (size_t i = 0; i < json.size(); ++i) {
    if (!json[i].is_string()) RefuseMember(Item(Place(key), i), "must be text");
    texts.push_back(json[i].get<std::string>());
  }
  return texts;
}

std::string TourObject::OneOf(const char* key, std::initializer_list<const char*> allowed) const {
  const std::string text = Text(key);
  if (std::find(allowed.begin(), allowed.end(), text) != allowed.end()) return text;
  std::string list;
  for (const char* a : allowed) list += (list.empty() ? "" : ", ") + std::string(a);
  RefuseMember(Place(key), "is '" + text + "', it must be one of: " + list);
}

Vec2 TourObject::Point(const char* key) const { return CheckedPoint(Get(key), Place(key)); }

std::vector<Vec2> TourObject::Points(const char* key) const {
  const Json& json = Array(key);
  std::vector<Vec2> points;
  for (size_t i = 0; i < json.size(); ++i) points.push_back(CheckedPoint(json[i], Item(Place(key), i)));
  return points;
}

std::vector<Vec2> TourObject::Ring(const char* key) const { return CheckedRing(Get(key), Place(key)); }

std::vector<std::vector<Vec2>> TourObject::Rings(const char* key) const {
  const Json& json = Array(key);
  std::vector<std::vector<Vec2>> rings;
  for (size_t i = 0; i < json.size(); ++i) rings.push_back(CheckedRing(json[i], Item(Place(key), i)));
  return rings;
}

Vec3 TourObject::CheckedColor(const Json& json, const std::string& place) {
  const auto color = json.is_string() ? ColorFromText(json.get<std::string>()) : std::nullopt;
  if (!color) RefuseMember(place, "must be a colour such as \"#2f4f8f\"");
  return *color;
}

Vec3 TourObject::Color(const char* key) const { return CheckedColor(Get(key), Place(key)); }

std::vector<Vec3> TourObject::Colors(const char* key) const {
  const Json& json = Array(key);
  if (json.empty()) RefuseMember(Place(key), "must not be empty");
  std::vector<Vec3> colors;
  for (size_t i = 0; i < json.size(); ++i) colors.push_back(CheckedColor(json[i], Item(Place(key), i)));
  return colors;
}

std::vector<float> TourObject::Reals(const char* key, double least, double most) const {
  const Json& json = Array(key);
  if (json.empty()) RefuseMember(Place(key), "must not be empty");
  std::vector<float> numbers;
  for (size_t i = 0; i < json.size(); ++i) {
    numbers.push_back(static_cast<float>(Checked(json[i], Item(Place(key), i), false, least, most)));
  }
  return numbers;
}

std::vector<int> TourObject::Wholes(const char* key, double least, double most) const {
  const Json& json = Array(key);
  std::vector<int> numbers;
  for (size_t i = 0; i < json.size(); ++i) {
    numbers.push_back(static_cast<int>(Checked(json[i], Item(Place(key), i), true, least, most)));
  }
  return numbers;
}

TourObject TourObject::Object(const char* key) const { return {Get(key), Place(key)}; }

std::vector<TourObject> TourObject::Objects(const char* key, size_t most) const {
  const Json& json = Array(key);
  if (json.size() > most)
    RefuseMember(Place(key), "has " + std::to_string(json.size()) + " of them, there may be " + std::to_string(most));
  std::vector<TourObject> objects;
  for (size_t i = 0; i < json.size(); ++i) objects.emplace_back(json[i], Item(Place(key), i));
  return objects;
}

void TourObject::Angle(const char* stem, float* radians, double least_deg, double most_deg) const {
  constexpr double kToRad = static_cast<double>(kPi) / 180, kSlack_rad = 1e-3;  // rounded on the way
  Number((std::string(stem) + "_rad").c_str(), radians, least_deg * kToRad - kSlack_rad,
         most_deg * kToRad + kSlack_rad);
}

void TourObject::Choice(const char* key, std::string* value, std::initializer_list<const char*> allowed) const {
  if (Has(key)) *value = OneOf(key, allowed);
}

}  // namespace flaneur
