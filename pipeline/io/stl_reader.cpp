#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <cmath>
#include <fstream>

#include "pipeline/io/polygon_soup.h"
#include "pipeline/io/scene_reader.h"
#include "runtime/base/text.h"

namespace flaneur {

Error ReadStl(const std::filesystem::path& path, Scene* scene, std::vector<std::string>* warnings, UpAxis up) {
  std::ifstream file(path, std::ios::binary);
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::array<uint32_t, 3>> faces;
  const auto bad = [&](const std::string& why) { return Fail(OneLine(path.string() + ": " + why)); };
  if (!CGAL::IO::read_STL(file, points, faces) || faces.empty()) return bad("not an STL file, or cut off");
  PolygonSoup soup;
  for (const auto& p : points) {
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
      return bad("vertex " + std::to_string(soup.points.size()) + " is not finite");
    soup.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto& face : faces) {
    soup.corners.insert(soup.corners.end(), face.begin(), face.end());
    soup.sizes.push_back(3);
  }
  soup.corner_places.assign(soup.corners.size(), PolygonSoup::kNone);
  soup.corner_normals.assign(soup.corners.size(), PolygonSoup::kNone);
  up = UpOf(soup, up, path.string(), "STL", warnings);
  TownBuilder builder;
  const int node = builder.AddNode(path.stem().string(), NodeKind::kUntagged);
  for (size_t corner = 0; corner < soup.corners.size(); corner += 3) AddFace(soup, corner, 3, up, {}, node, &builder);
  return builder.Finish(path.string(), {"", false}, scene, nullptr, warnings);
}

}  // namespace flaneur
