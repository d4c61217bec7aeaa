// What a kiosk keeps of its visits, through power cuts and years.
#include "runtime/visit/visit_log.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

struct Folder {
  Folder() { std::filesystem::remove_all(path); }
  ~Folder() { std::filesystem::remove_all(path); }
  std::string Text(const char* name = "visits.csv") const {
    std::string text;
    EXPECT_FALSE(ReadTextFile(path / name, &text));
    return text;
  }
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("flaneur_visits_" + std::to_string(::getpid()));
};

VisitRecord Visit(float length_s, const char* language) { return {1700000000, length_s, language, 3, 7}; }

TEST(VisitLog, KeepsALineAVisitUnderAHead) {
  const Folder folder;
  ASSERT_EQ(AppendVisit(folder.path, Visit(83.6f, "de")).message, "");
  ASSERT_EQ(AppendVisit(folder.path, Visit(5, "a,\"b\n")).message, "");
  std::istringstream lines(folder.Text());
  std::string head, first, second, more;
  std::getline(lines, head);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(head, "began,length_s,language,stops_reached,stops");
  EXPECT_EQ(first.substr(0, 6), "2023-1");
  EXPECT_EQ(first.substr(16), ",84,de,3,7");
  EXPECT_EQ(second.substr(16), ",5,a  b ,3,7") << "nothing breaks the columns";
  EXPECT_FALSE(std::getline(lines, more));
}

TEST(VisitLog, ALineThatAPowerCutLeftUnfinishedIsGone) {
  const Folder folder;
  ASSERT_FALSE(AppendVisit(folder.path, Visit(10, "de")));
  const std::string whole = folder.Text();
  std::ofstream(folder.path / "visits.csv", std::ios::app) << "2023-11-14 22:1";
  ASSERT_FALSE(AppendVisit(folder.path, Visit(10, "de")));
  EXPECT_EQ(folder.Text(), whole + whole.substr(whole.find('\n') + 1));
  ASSERT_FALSE(WriteTextFile(folder.path / "visits.csv", "began,le"));
  ASSERT_FALSE(AppendVisit(folder.path, Visit(10, "de")));
  EXPECT_EQ(folder.Text(), whole);
}

TEST(VisitLog, NeverGrowsBeyondItsBounds) {
  const Folder folder;
  for (int k = 0; k < kOldLogs + 3; ++k) {
    ASSERT_FALSE(AppendVisit(folder.path, Visit(static_cast<float>(k), "de")));
    std::ofstream(folder.path / "visits.csv", std::ios::app) << std::string(kMostVisitLog_bytes, 'x') << '\n';
  }
  ASSERT_FALSE(AppendVisit(folder.path, Visit(99, "fr")));
  size_t files = 0;
  for (const auto& unused : std::filesystem::directory_iterator(folder.path)) static_cast<void>(unused), ++files;
  EXPECT_EQ(files, static_cast<size_t>(kOldLogs) + 1);
  EXPECT_NE(folder.Text().find(",99,fr"), std::string::npos);
  EXPECT_NE(folder.Text("visits.1.csv").find("," + std::to_string(kOldLogs + 2) + ",de"), std::string::npos);
}

TEST(VisitLog, SaysWhyItCannotBeKept) {
  const Error error = AppendVisit("/proc/nowhere", Visit(1, "de"));
  EXPECT_EQ(error.message.rfind("/proc/nowhere/visits.csv: cannot be written", 0), 0u) << error.message;
}

}  // namespace
}  // namespace flaneur
