#include "pipeline/footprint/map.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

#include "runtime/base/file.h"
#include "tests/unit/pipeline/footprint/test_town.h"

namespace flaneur {
namespace {

TEST(Map, ShowsNamesAndFindingsAndEscapesThem) {
  TestTown town;
  town.Ground().Node("Inn <\"Rose\" & Crown>", NodeKind::kBuilding).Box({10, 10, -1}, {18, 16, 8});
  Finding finding;
  finding.code = 301, finding.feature = "Inn", finding.message = "wall not covered";
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("flaneur_map_" + std::to_string(::getpid()) + ".svg");
  ASSERT_EQ(WriteMap(path, Extract(town), {"town", nullptr, {finding}}).message, "");
  std::vector<uint8_t> bytes;
  ASSERT_EQ(ReadFile(path, &bytes).message, "");
  std::filesystem::remove(path);
  const std::string text(bytes.begin(), bytes.end());
  EXPECT_NE(text.find("Inn &lt;&quot;Rose&quot; &amp; Crown&gt;"), std::string::npos);
  EXPECT_EQ(text.find("<\"Rose\""), std::string::npos);
  EXPECT_NE(text.find("301"), std::string::npos);
  EXPECT_NE(text.find("wall not covered"), std::string::npos);
  EXPECT_NE(text.find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace flaneur
