#include "pipeline/core/results.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {
namespace {

namespace fs = std::filesystem;

class ResultsTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_FALSE(outer_.Create("flaneur_test_"));
    folder_ = outer_.path() / "out";
    fs::create_directories(folder_);
  }
  // Replaces a and b, or where `b` is empty a alone; what staging lacks goes.
  Error Replace(const std::string& a, const std::string& b) {
    TemporaryFolder staging;
    if (Error e = staging.Create(".flaneur_results_", folder_)) return e;
    if (Error e = WriteTextFile(staging.path() / "a", a)) return e;
    if (!b.empty()) {
      if (Error e = WriteTextFile(staging.path() / "b", b)) return e;
    }
    return ReplaceTogether(folder_, &staging, {"a", "b"});
  }
  std::string All() const {
    std::string all;
    for (const auto& entry : fs::directory_iterator(folder_)) {
      std::string text = entry.path().filename().string() + "=";
      std::string content;
      if (entry.is_symlink() || ReadTextFile(entry.path(), &content)) content = "?";
      all = all < text ? all + text + content + ";" : text + content + ";" + all;
    }
    return all;
  }

  TemporaryFolder outer_;
  fs::path folder_;
};

TEST_F(ResultsTest, AreReplacedTogetherAndLeaveNothingElse) {
  ASSERT_FALSE(Replace("1", "1"));
  EXPECT_EQ(All(), "a=1;b=1;");
  ASSERT_FALSE(Replace("2", "2"));
  EXPECT_EQ(All(), "a=2;b=2;");
  ASSERT_FALSE(Replace("3", ""));
  EXPECT_EQ(All(), "a=3;");
}

TEST_F(ResultsTest, AFolderInTheWayChangesNothing) {
  ASSERT_FALSE(Replace("1", "1"));
  fs::remove(folder_ / "b");
  fs::create_directories(folder_ / "b/in the way");
  EXPECT_NE(Replace("2", "2").message.find("is a folder"), std::string::npos);
  std::string text;
  ASSERT_FALSE(ReadTextFile(folder_ / "a", &text));
  EXPECT_EQ(text, "1");
}

TEST_F(ResultsTest, AStrangersLinksTakeNothingFromElsewhere) {
  const fs::path home = outer_.path() / "home";
  ASSERT_FALSE(WriteTextFile(home / "a", "kept"));
  fs::create_symlink("../home", folder_ / ".flaneur_current");
  fs::create_symlink(".flaneur_current/a", folder_ / "a");
  RecoverResults(folder_);
  EXPECT_TRUE(fs::is_regular_file(home / "a"));
  ASSERT_FALSE(Replace("1", "1"));
  EXPECT_EQ(All(), "a=1;b=1;");
  std::string text;
  ASSERT_FALSE(ReadTextFile(home / "a", &text));
  EXPECT_EQ(text, "kept");
}

TEST_F(ResultsTest, AManifestNamesFilesOfItsFolderAlone) {
  ASSERT_FALSE(WriteTextFile(folder_ / kManifest,
                             R"({"key": "k", "files": {"a": {}, "../b": {}, "/etc/c": {}, "..": {}, "": {}}})"));
  EXPECT_EQ(ResultNames(folder_), std::vector<std::string>{"a"});
  EXPECT_FALSE(ResultsAreWhole(folder_, "k"));
  for (const char* text : {R"({"key": 5, "files": {}})", R"({"files": {"a": {"sha256": 5}}, "key": "k"})", "[]", "5"}) {
    ASSERT_FALSE(WriteTextFile(folder_ / kManifest, text));
    EXPECT_FALSE(ResultsAreWhole(folder_, "k")) << text;
  }
}

TEST_F(ResultsTest, WhatAKilledProcessLeftGoes) {
  const pid_t child = ::fork();
  if (child == 0) {
    TemporaryFolder left;
    const bool made = !left.Create(".flaneur_results_", folder_) && !WriteTextFile(left.path() / "a", "half");
    ::_exit(made ? 0 : 1);  // no destructor runs
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  TemporaryFolder living;  // of somebody who is still at work
  ASSERT_FALSE(living.Create(".flaneur_other_", folder_));
  RecoverResults(folder_);
  EXPECT_EQ(All().find(".flaneur_results_"), std::string::npos);
  EXPECT_TRUE(fs::is_directory(living.path()));
}

TEST_F(ResultsTest, AManifestTellsOneChangedByte) {
  TemporaryFolder staging;
  ASSERT_FALSE(staging.Create(".flaneur_results_", folder_));
  ASSERT_FALSE(WriteTextFile(staging.path() / "a", "content"));
  ASSERT_FALSE(WriteManifest(staging.path(), "key", {"a"}));
  ASSERT_FALSE(ReplaceTogether(folder_, &staging, {"a", kManifest}));
  EXPECT_TRUE(ResultsAreWhole(folder_, "key"));
  EXPECT_FALSE(ResultsAreWhole(folder_, "other key"));
  ASSERT_FALSE(WriteTextFile(folder_ / "a", "kontent"));
  EXPECT_FALSE(ResultsAreWhole(folder_, "key"));
}

}  // namespace
}  // namespace flaneur
