// Tests of what tour.toml says: the tour's file in a folder of its own.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "pipeline/cli/tour_settings.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

namespace flaneur {

struct ReadsTour : ::testing::Test {
  explicit ReadsTour(std::string begins) : begin(std::move(begins)) {}
  void SetUp() override { ASSERT_EQ(folder.Create("flaneur_test_").message, ""); }

  // What is wrong, behind the file's name.
  std::string Read(const std::string& more) {
    const auto path = folder.path() / "tour.toml";
    EXPECT_FALSE(WriteTextFile(path, begin + more));
    const std::string message = ReadTourSettings(path, &settings).message;
    return message.empty() ? "" : message.substr(path.string().size());
  }
  bool Refuses(const std::string& more, const std::string& why) {
    const std::string message = Read(more);
    EXPECT_NE(message.find(why), std::string::npos) << message;
    return message.find(':') == 0;
  }

  const std::string begin;  // of every tour
  TemporaryFolder folder;
  TourSettings settings;
};

}  // namespace flaneur
