#include "pipeline/footprint/findings.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

namespace flaneur {
namespace {

TEST(Findings, CodesAreUniqueAndAscending) {
  int last = 0;
  for (const FindingKind& kind : FindingKinds()) {
    EXPECT_GT(kind.code, last);
    last = kind.code;
    EXPECT_EQ(&KindOf(kind.code), &kind);
  }
}

// docs/findings.md has a heading "### CODE title (severity)" for each kind, and no other.
TEST(Findings, AreTheOnesInTheDocumentation) {
  std::ifstream file(std::filesystem::path(FLANEUR_SOURCE_DIR) / "docs/findings.md");
  ASSERT_TRUE(file);
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  std::set<std::string> written, expected;
  const std::regex heading("### ([0-9]+ [^\n]*)");
  for (std::sregex_iterator match(text.begin(), text.end(), heading), end; match != end; ++match)
    written.insert((*match)[1]);
  for (const FindingKind& kind : FindingKinds())
    expected.insert(std::to_string(kind.code) + " " + kind.title + " (" + SeverityName(kind.severity) + ")");
  EXPECT_EQ(written, expected);
}

TEST(Findings, JsonKeepsTheAgreedKeys) {
  Finding finding;
  finding.code = 301, finding.feature = "house \"7\"", finding.at_m = {1.5, -2}, finding.value = 0.12,
  finding.limit = 0.01;
  finding.message = "wall not covered";
  Finding warning;
  warning.code = 403, warning.severity = Severity::kWarning, warning.feature = "a", warning.other = "b";
  const auto json = nlohmann::json::parse(FindingsJson({finding, warning}));
  EXPECT_EQ(json["version"], 1);
  EXPECT_EQ(json["errors"], 1);
  EXPECT_EQ(json["warnings"], 1);
  ASSERT_EQ(json["findings"].size(), 2u);
  const auto& first = json["findings"][0];
  EXPECT_EQ(first["code"], 301);
  EXPECT_EQ(first["severity"], "error");
  EXPECT_EQ(first["feature"], "house \"7\"");
  EXPECT_TRUE(first["other"].is_null());
  EXPECT_EQ(first["at_m"], nlohmann::json::array({1.5, -2.0}));
  EXPECT_EQ(first["value"], 0.12);
  EXPECT_EQ(first["limit"], 0.01);
  EXPECT_EQ(first["advice"], KindOf(301).advice);
  EXPECT_EQ(json["findings"][1]["other"], "b");
  EXPECT_EQ(json["findings"][1]["severity"], "warning");
}

Finding At(int code, const std::string& feature, Point2 at = {}) {
  Finding finding;
  finding.code = code, finding.severity = KindOf(code).severity, finding.feature = feature, finding.at_m = at;
  finding.message = std::string(KindOf(code).title) + ": '" + feature + "'";
  return finding;
}

TEST(Findings, OfOneCauseAreOneWithACount) {
  std::vector<Finding> findings;
  for (int i = 0; i < 20; ++i) findings.push_back(At(303, "house_" + std::to_string(i)));
  findings.push_back(At(403, "a"));
  SortFindings(&findings);
  std::vector<Finding> few = findings;
  JoinFindings(30, &findings);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].Count(), 20u);
  const auto json = nlohmann::json::parse(FindingsJson(findings))["findings"];
  EXPECT_EQ(json[0]["count"], 20);
  EXPECT_EQ(json[0]["features"].size(), 20u);
  EXPECT_FALSE(json[1].contains("count"));
  JoinFindings(100, &few);
  EXPECT_EQ(few.size(), 21u) << "a fifth of the obstacles each have their own fault";
}

TEST(Findings, ThatAreAcceptedAreNoErrors) {
  std::vector<Finding> findings{At(502, "alley", {10, 20}), At(502, "other", {50, 20}), At(503, "alley", {10, 20})};
  const std::vector<AcceptedFinding> accepted{{502, {12, 20}, 5, "meant so"}, {504, {12, 20}, 5, "gone"}};
  EXPECT_EQ(AcceptFindings(accepted, &findings), std::vector<size_t>{1});
  EXPECT_EQ(findings[0].severity, Severity::kAccepted);
  EXPECT_EQ(findings[1].severity, Severity::kError);
  EXPECT_EQ(findings[2].severity, Severity::kError);
  const auto json = nlohmann::json::parse(FindingsJson(findings));
  EXPECT_EQ(json["errors"], 2);
  EXPECT_EQ(json["findings"][0]["severity"], "accepted");
  EXPECT_EQ(json["findings"][0]["reason"], "meant so");
}

}  // namespace
}  // namespace flaneur
