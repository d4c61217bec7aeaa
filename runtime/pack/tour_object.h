// One object of the FLANEUR_tour extension, read member by member. What is missing, of another type or out of range is
// refused by its place, as FLANEUR_tour.places[3].kind. Internal to runtime/pack.
#pragma once
#include <initializer_list>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "runtime/base/limits.h"
#include "runtime/base/math.h"
#include "runtime/pack/gltf_file.h"

namespace flaneur {

class TourObject {
 public:
  static constexpr double kAnything = 1e30;
  static constexpr size_t kAnyNumber = std::numeric_limits<size_t>::max();
  static constexpr double kAboveZero = std::numeric_limits<double>::min();  // as the least: zero is refused

  // Refuses what is no object. `place` is how messages call it. The JSON must outlive it.
  TourObject(const Json& json, std::string place);

  bool Has(const char* key) const { return json_.contains(key); }
  std::vector<std::string> Keys() const;
  float Real(const char* key, double least = -kAnything, double most = kAnything) const;  // finite
  int Whole(const char* key, double least, double most) const;
  float Yaw(const char* key) const;  // radians, some turns at most
  std::string Text(const char* key, size_t most_bytes = kMostName_bytes) const;
  std::vector<std::string> Texts(const char* key) const;
  std::string OneOf(const char* key, std::initializer_list<const char*> allowed) const;
  Vec2 Point(const char* key) const;  // within kMostCoordinate_m
  std::vector<Vec2> Points(const char* key) const;
  std::vector<Vec2> Ring(const char* key) const;  // at least three points
  std::vector<std::vector<Vec2>> Rings(const char* key) const;
  std::vector<float> Reals(const char* key, double least, double most) const;  // at least one
  std::vector<int> Wholes(const char* key, double least, double most) const;
  Vec3 Color(const char* key) const;                // "#rrggbb"
  std::vector<Vec3> Colors(const char* key) const;  // at least one
  TourObject Object(const char* key) const;
  std::vector<TourObject> Objects(const char* key, size_t most = kAnyNumber) const;

  // For VisitFields: a member that is missing keeps its value.
  template <typename T>
  void Number(const char* key, T* value, double least, double most) const {
    if (Has(key)) *value = static_cast<T>(Checked(Get(key), Place(key), std::is_integral_v<T>, least, most));
  }
  void Angle(const char* stem, float* radians, double least_deg, double most_deg) const;
  void Choice(const char* key, std::string* value, std::initializer_list<const char*> allowed) const;

  // The number of a buffer view, of `views`.
  int View(const char* key, size_t views) const { return Whole(key, 0, static_cast<double>(views) - 1); }

  [[noreturn]] void Refuse(const std::string& why) const;

 private:
  const Json& Get(const char* key) const;
  const Json& Array(const char* key) const;
  std::string Place(const std::string& key) const { return place_ + "." + key; }
  static double Checked(const Json& json, const std::string& place, bool whole, double least, double most);
  static Vec2 CheckedPoint(const Json& json, const std::string& place);
  static Vec3 CheckedColor(const Json& json, const std::string& place);
  static std::vector<Vec2> CheckedRing(const Json& json, const std::string& place);

  const Json& json_;
  std::string place_;
};

}  // namespace flaneur
