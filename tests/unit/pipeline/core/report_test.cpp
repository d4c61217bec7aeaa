#include "pipeline/core/report.h"

#include <gtest/gtest.h>

namespace flaneur {
namespace {

TEST(Report, ShowsAPersonsPicturesAndWhatTheTintsReach) {
  BakeReport report;
  StageReport avatar, impostor, tint;
  avatar.stage = "avatar", impostor.stage = "impostor", tint.stage = "tint";
  avatar.item = impostor.item = tint.item = "child";
  impostor.picture_png = {1, 2, 3};
  report.stages = {avatar, tint, impostor};
  EXPECT_NE(ReportHtml(report).find("impostor of child"), std::string::npos);
  EXPECT_EQ(ReportHtml(report).find("tint of child"), std::string::npos) << "no tints, no picture";
  report.stages[1].picture_png = {4, 5, 6};
  EXPECT_NE(ReportHtml(report).find("alt=\"tint of child\" src=\"data:image/png;base64,BAUG\""), std::string::npos);
}

}  // namespace
}  // namespace flaneur
