#include "pipeline/cli/tours_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "pipeline/core/report.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

std::string StateOf(const BakedTour& tour) {
  if (tour.error) return "failed";
  return tour.unchanged ? "unchanged" : "baked";
}

nlohmann::ordered_json Json(const BakedTour& tour) {
  std::error_code ec;
  nlohmann::ordered_json json{{"tour", tour.name}, {"file", tour.tour.string()}, {"state", StateOf(tour)}};
  if (tour.error) json["error"] = tour.error.message;
  else json["pack"] = {{"path", tour.pack.string()}, {"bytes", fs::file_size(tour.pack, ec)}};
  json["report"] = tour.report.string();
  json["work_s"] = std::round(tour.work_s * 1000) / 1000;
  json["warnings"] = tour.warnings;
  json["errors_found"] = tour.errors_found;
  return json;
}

}  // namespace

Error WriteToursReport(const fs::path& folder, const std::vector<BakedTour>& baked) {
  nlohmann::ordered_json all{{"version", 1}};
  all["tours"] = nlohmann::ordered_json::array();
  std::vector<TourRow> rows;
  for (const BakedTour& tour : baked) {
    all["tours"].push_back(Json(tour));
    std::error_code ec;
    const double mb = tour.error ? 0 : static_cast<double>(fs::file_size(tour.pack, ec)) / 1e6;
    rows.push_back({tour.name.empty() ? tour.tour.string() : tour.name, StateOf(tour), tour.error.message,
                    fs::relative(tour.report, folder, ec).string(), mb, tour.work_s, tour.warnings, tour.errors_found});
  }
  if (Error e = WriteTextFile(folder / "report.html", ToursHtml(rows))) return e;
  return WriteTextFile(folder / "report.json",
                       all.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace flaneur
