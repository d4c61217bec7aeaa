#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include "pipeline/core/report.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr size_t kMaxFindingsOfACode = 100;

constexpr const char* kStyle = R"(
:root{--ink:#2b2622;--soft:#7a6f63;--line:#e4dccf;--paper:#fbf8f2;--card:#fff;--accent:#8a4b2a}
body{font:15px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:1080px;margin:2.5rem auto;padding:0 1.2rem}
h1{font:600 2rem Georgia,serif;margin:0} h2{font:600 1.25rem Georgia,serif;margin:2.4rem 0 .7rem;color:var(--accent)}
.soft{color:var(--soft)} .cards{display:flex;flex-wrap:wrap;gap:.7rem;margin-top:1.2rem}
.card{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:.6rem 1rem;min-width:7.5rem}
.card b{display:block;font-size:1.35rem;font-weight:600} table{border-collapse:collapse;width:100%;background:var(--card)}
td,th{padding:.35rem .6rem;border-bottom:1px solid var(--line);text-align:left;vertical-align:top}
th{font-weight:600;color:var(--soft);font-size:.85rem} .n{text-align:right;white-space:nowrap;font-variant-numeric:tabular-nums}
.person{display:grid;grid-template-columns:minmax(0,1fr) auto;gap:1rem;background:var(--card);border:1px solid var(--line);
border-radius:8px;padding:.8rem 1rem;margin-bottom:.7rem;align-items:center} .person h3{margin:0;font-size:1.05rem}
.person img{max-width:100%;background:linear-gradient(#dfe6ea,#c9d3d6);border-radius:4px}
.person table{background:none;font-size:.88rem;width:auto} .person th,.person td{padding:.3rem .5rem} .map svg{width:100%;height:auto;background:#fff;border:1px solid var(--line)}
details{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:.4rem .8rem;margin-bottom:.4rem}
summary{cursor:pointer} .error{color:#a3271c;font-weight:600} .warning{color:#9a6a00;font-weight:600} li{margin:.15rem 0}
)";

std::string Escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '<') out += "&lt;";
    else if (c == '>') out += "&gt;";
    else if (c == '&') out += "&amp;";
    else if (c == '"') out += "&quot;";
    else out += c;
  }
  return out;
}

std::string Format(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

// 1234567 as 1,234,567; other numbers with up to four digits that count.
std::string Figure(double value) {
  if (value != static_cast<double>(static_cast<int64_t>(value))) return Format("%.4g", value);
  std::string digits = Format("%.0f", value);
  for (int i = Count(digits) - 3; i > (value < 0 ? 1 : 0); i -= 3) {
    digits.insert(static_cast<size_t>(i), ",");
  }
  return digits;
}

std::string Base64(const std::vector<uint8_t>& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
    for (size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : kLetters[word >> (18 - 6 * k) & 63];
  }
  return out;
}

double FigureOf(const BakeReport& report, const std::string& stage, const std::string& key) {
  for (const StageReport& s : report.stages) {
    for (const auto& [name, value] : s.figures) {
      if (s.stage == stage && name == key) return value;
    }
  }
  return 0;
}

std::string Card(const std::string& value, const std::string& meaning) {
  return "<div class=\"card\"><b>" + value + "</b><span class=\"soft\">" + meaning + "</span></div>";
}

std::string Summary(const BakeReport& report) {
  double work_s = 0, kinds = 0;
  for (const StageReport& stage : report.stages) {
    work_s += stage.work_s;
    kinds += stage.stage == "avatar" ? 1 : 0;
  }
  const auto errors = std::count_if(report.findings.begin(), report.findings.end(),
                                    [](const ReportFinding& f) { return f.severity == "error"; });
  return "<h1>" + Escaped(report.tour) + "</h1><div class=\"soft\">" + Escaped(report.pack_path) +
         "</div><div class=\"cards\">" + Card(Format("%.1f MB", static_cast<double>(report.pack_bytes) / 1e6), "pack") +
         Card(Figure(kinds), "kinds of people") +
         Card(Figure(FigureOf(report, "town", "triangles")), "triangles of the town") +
         Card(Figure(FigureOf(report, "footprints", "obstacles")), "obstacles") +
         Card(Figure(static_cast<double>(errors)), "errors the check found") +
         Card(Format("%.0f s", work_s), "of processors' work, when made") + "</div>";
}

std::string Warnings(const BakeReport& report) {
  if (report.warnings.empty()) return "";
  std::string out = "<h2>Warnings</h2><ul>";
  for (const std::string& warning : report.warnings) out += "<li>" + Escaped(warning) + "</li>";
  return out + "</ul>";
}

const StageReport* Find(const BakeReport& report, const char* stage, const std::string& item) {
  for (const StageReport& s : report.stages) {
    if (s.stage == stage && s.item == item) return &s;
  }
  return nullptr;
}

// What a stage shows of the item; empty where it shows nothing.
std::string Picture(const BakeReport& report, const std::string& stage, const std::string& item) {
  const StageReport* found = Find(report, stage.c_str(), item);
  if (found == nullptr || found->picture_png.empty()) return "";
  return "<img alt=\"" + stage + " of " + Escaped(item) + "\" src=\"data:image/png;base64," +
         Base64(found->picture_png) + "\">";
}

std::string Person(const BakeReport& report, const StageReport& avatar) {
  std::string out = "<div class=\"person\"><div><h3>" + Escaped(avatar.item) + "</h3><div class=\"soft\">";
  for (const auto& [key, value] : avatar.figures) out += Escaped(key) + " " + Figure(value) + " &nbsp; ";
  out += "</div>";
  for (const auto& [word, text] : avatar.notes)
    out += "<div><span class=\"soft\">" + Escaped(word) + "</span> " + Escaped(text) + "</div>";
  out += Picture(report, "impostor", avatar.item) + Picture(report, "tint", avatar.item);
  out +=
      "</div><table><tr><th class=\"n\">Triangles<th class=\"n\">Error, bind pose<th class=\"n\">Error, walking"
      "<th class=\"n\">Needed from</tr>";
  for (const AvatarLevel& level : avatar.levels) {
    out += "<tr><td class=\"n\">" + Figure(level.triangles) + "<td class=\"n\">" +
           Format("%.2f mm", static_cast<double>(level.error_mm)) + "<td class=\"n\">" +
           Format("%.2f mm", static_cast<double>(level.posed_error_mm)) + "<td class=\"n\">" +
           Format("%.0f px", static_cast<double>(level.switch_px)) + "</tr>";
  }
  return out + "</table></div>";
}

std::string People(const BakeReport& report) {
  std::string out = "<h2>People</h2>";
  for (const StageReport& stage : report.stages) {
    if (stage.stage == "avatar") out += Person(report, stage);
  }
  return out;
}

std::string Findings(const BakeReport& report) {
  std::map<int, std::vector<const ReportFinding*>> by_code;
  for (const ReportFinding& f : report.findings) by_code[f.code].push_back(&f);
  if (by_code.empty()) return "";
  std::string out = "<h2>What the check found</h2>";
  for (const auto& [code, findings] : by_code) {
    const ReportFinding& first = *findings.front();
    out += "<details><summary><span class=\"" + first.severity + "\">" + std::to_string(code) + "</span> " +
           Escaped(first.title) + ": " + Figure(static_cast<double>(findings.size())) + "</summary><p class=\"soft\">" +
           Escaped(first.advice) + "</p><table>";
    for (size_t i = 0; i < std::min(findings.size(), kMaxFindingsOfACode); ++i) {
      const ReportFinding& f = *findings[i];
      out += "<tr><td>" + Escaped(f.feature) + "<td class=\"n\">" + Format("%.1f, ", static_cast<double>(f.at_m.x)) +
             Format("%.1f", static_cast<double>(f.at_m.y)) + "<td>" + Escaped(f.message) + "</tr>";
    }
    if (findings.size() > kMaxFindingsOfACode) {
      out += "<tr><td colspan=\"3\" class=\"soft\">and " +
             Figure(static_cast<double>(findings.size() - kMaxFindingsOfACode)) + " more</tr>";
    }
    out += "</table></details>";
  }
  return out;
}

// The stops' captions, a column a language.
std::string Stops(const BakeReport& report) {
  if (report.stops.empty()) return "";
  std::set<std::string> languages;
  for (const ReportStop& stop : report.stops) {
    for (const auto& [language, caption] : stop.captions) languages.insert(language);
  }
  std::string out = "<h2>Guided tour</h2><table><tr><th class=\"n\">Stop<th class=\"n\">At, m";
  for (const std::string& language : languages) out += "<th>" + Escaped(language);
  out += "</tr>";
  for (size_t i = 0; i < report.stops.size(); ++i) {
    const ReportStop& stop = report.stops[i];
    out += "<tr><td class=\"n\">" + Figure(static_cast<double>(i + 1)) + "<td class=\"n\">" +
           Format("%.1f, ", static_cast<double>(stop.position_m.x)) +
           Format("%.1f", static_cast<double>(stop.position_m.y));
    for (const std::string& language : languages) {
      const auto caption = stop.captions.find(language);
      out += "<td>" + (caption == stop.captions.end() ? "<span class=\"soft\">–</span>" : Escaped(caption->second));
    }
    out += "</tr>\n";
  }
  return out + "</table>";
}

// What this bake made, and what was as before.
std::string Changed(const BakeReport& report) {
  std::string made;
  size_t kept = 0;
  for (const StageReport& stage : report.stages) {
    if (stage.cached) ++kept;
    else made += (made.empty() ? "" : ", ") + stage.stage + " " + stage.item;
  }
  return "<h2>Since the last bake</h2><p>Made anew: " + Escaped(made.empty() ? "nothing" : made) +
         ".<br><span class=\"soft\">" + Figure(static_cast<double>(kept)) + " of " +
         Figure(static_cast<double>(report.stages.size())) + " steps were as before.</span></p>";
}

std::string Stages(const BakeReport& report) {
  std::string out =
      "<h2>What it took</h2><table><tr><th>Step<th>Item<th class=\"n\">Clock, s<th class=\"n\">Work, s<th "
      "class=\"n\">Memory, MB"
      "<th>Figures</tr>";
  for (const StageReport& stage : report.stages) {
    out += "<tr><td>" + Escaped(stage.stage) + "<td>" + Escaped(stage.item) + "<td class=\"n\">" +
           (stage.cached ? std::string("as before") : Format("%.1f", stage.seconds)) + "<td class=\"n\">" +
           Format("%.1f", stage.work_s) + "<td class=\"n\">" + Format("%.0f", stage.peak_mb) + "<td class=\"soft\">";
    for (const auto& [key, value] : stage.figures) out += Escaped(key) + " " + Figure(value) + " &nbsp; ";
    out += "</tr>";
  }
  return out + "</table>";
}

}  // namespace

std::string ToursHtml(const std::vector<TourRow>& tours) {
  std::string out = "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Bake report</title><style>" +
                    std::string(kStyle) + "</style>\n<h1>" + Figure(static_cast<double>(tours.size())) +
                    " tours</h1><p><table><tr><th>Tour<th>State<th class=\"n\">Pack, MB<th class=\"n\">Work, s"
                    "<th class=\"n\">Warnings<th class=\"n\">Errors the check found</tr>";
  for (const TourRow& tour : tours) {
    const std::string name = Escaped(tour.name);
    out += "<tr><td>" + (tour.error.empty() ? "<a href=\"" + Escaped(tour.report) + "\">" + name + "</a>" : name) +
           "<td><span class=\"" + (tour.error.empty() ? "soft" : "error") + "\">" + tour.state + "</span> " +
           Escaped(tour.error) + "<td class=\"n\">" + Format("%.1f", tour.pack_mb) + "<td class=\"n\">" +
           Format("%.1f", tour.work_s) + "<td class=\"n\">" + Figure(static_cast<double>(tour.warnings)) +
           "<td class=\"n\">" + Figure(static_cast<double>(tour.errors_found)) + "</tr>\n";
  }
  return out + "</table></html>\n";
}

std::string ReportHtml(const BakeReport& report) {
  std::string out = "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>" + Escaped(report.tour) +
                    ": bake report</title><style>" + kStyle + "</style>\n";
  out += Summary(report) + "\n" + Warnings(report) + "\n" + People(report) + "\n";
  if (!report.map_svg.empty()) {
    const size_t svg = report.map_svg.find("<svg");
    out += "<h2>Town and obstacles</h2><div class=\"map\">" +
           report.map_svg.substr(svg == std::string::npos ? 0 : svg) + "</div>\n";
  }
  return out + Stops(report) + "\n" + Findings(report) + "\n" + Changed(report) + "\n" + Stages(report) + "</html>\n";
}

}  // namespace flaneur
