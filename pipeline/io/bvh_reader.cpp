#include "pipeline/io/bvh_reader.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/core/obj_files.h"
#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"
#include "runtime/base/file.h"
#include "runtime/base/limits.h"
#include "runtime/base/text.h"

namespace flaneur {
namespace {

constexpr float kKeysPerSecond = 30;
constexpr size_t kMostJoints = 4096;
constexpr float kMostFrames = 1e6f;  // of a minute

enum class Channel { kX, kY, kZ, kTurnX, kTurnY, kTurnZ };

struct BvhJoint {
  std::vector<Channel> channels;
  size_t first = 0;  // of its numbers in a frame
};

// Words of a text and the line that each stands in.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}

  std::string_view Next() {
    while (at_ < text_.size() && IsSpace(text_[at_])) Step();
    const size_t begin = at_;
    while (at_ < text_.size() && !IsSpace(text_[at_])) Step();
    return text_.substr(begin, at_ - begin);
  }

  // What is left of the line, up to a brace.
  std::string_view RestOfLine() {
    while (at_ < text_.size() && text_[at_] != '\n' && IsSpace(text_[at_])) Step();
    const size_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '{') Step();
    std::string_view rest = text_.substr(begin, at_ - begin);
    while (!rest.empty() && IsSpace(rest.back())) rest.remove_suffix(1);
    return rest;
  }

  int line() const { return line_; }

 private:
  static bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  void Step() { line_ += text_[at_++] == '\n'; }

  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

class BvhReader {
 public:
  BvhReader(std::string_view text, Avatar* skeleton) : words_(text), skeleton_(*skeleton) {}

  Error Read(float longest_s) {
    if (words_.Next() != "HIERARCHY") return Wrong("it does not begin with HIERARCHY: not a BVH file");
    if (words_.Next() != "ROOT") return Wrong("no ROOT after HIERARCHY");
    if (Error e = ReadJoint(-1)) return e;
    if (words_.Next() != "MOTION") return Wrong("no MOTION after the first skeleton (only one is read)");
    return ReadMotion(longest_s);
  }

 private:
  Error Wrong(const std::string& what) const { return Fail("line " + std::to_string(words_.line()) + ": " + what); }

  Error Number(float* value) {
    const std::string_view word = words_.Next();
    if (word.empty()) return Wrong("the file ends where a number is due");
    if (!ReadNumber(word, value) || !std::isfinite(*value))
      return Wrong("'" + OneLine(std::string(word)) + "' is no number");
    return Ok();
  }

  // After ROOT or JOINT, without recursion over the file's depth.
  Error ReadJoint(int parent) {
    std::vector<int> open;
    std::string name(words_.RestOfLine());
    if (Error e = Open(name, parent, &open)) return e;
    while (!open.empty()) {
      const std::string_view word = words_.Next();
      if (word == "}") {
        open.pop_back();
      } else if (word == "OFFSET") {
        Vec3& offset = At(skeleton_.joints, open.back()).rest.translation;
        for (float* each : {&offset.x, &offset.y, &offset.z}) {
          if (Error e = Number(each)) return e;
        }
      } else if (word == "CHANNELS") {
        if (Error e = ReadChannels(open.back())) return e;
      } else if (word == "JOINT") {
        name = words_.RestOfLine();
        if (Error e = Open(name, open.back(), &open)) return e;
      } else if (word == "End") {
        words_.RestOfLine();
        if (Error e = Open(At(skeleton_.joints, open.back()).name + "_end", open.back(), &open)) return e;
      } else {
        return Wrong(word.empty() ? "the file ends within the hierarchy"
                                  : "'" + OneLine(std::string(word)) + "' is not part of a hierarchy");
      }
    }
    return Ok();
  }

  Error Open(const std::string& name, int parent, std::vector<int>* open) {
    if (words_.Next() != "{") return Wrong("no { after joint '" + OneLine(name) + "'");
    if (name.size() > kMostName_bytes)
      return Wrong("a joint's name is longer than " + std::to_string(kMostName_bytes) + " bytes");
    if (skeleton_.joints.size() >= kMostJoints) return Wrong("more than " + std::to_string(kMostJoints) + " joints");
    Joint joint;
    joint.name = name;
    joint.parent = parent;
    open->push_back(Count(skeleton_.joints));
    skeleton_.joints.push_back(std::move(joint));
    channels_.emplace_back();
    return Ok();
  }

  Error ReadChannels(int joint) {
    static constexpr std::array<std::string_view, 6> kNames = {"Xposition", "Yposition", "Zposition",
                                                               "Xrotation", "Yrotation", "Zrotation"};
    float count = 0;
    if (Error e = Number(&count)) return e;
    BvhJoint& own = At(channels_, joint);
    own.first = width_;
    for (int i = 0; i < static_cast<int>(std::clamp(count, 0.0f, 12.0f)); ++i) {
      const std::string_view word = words_.Next();
      const auto* known = std::find(kNames.begin(), kNames.end(), word);
      if (known == kNames.end()) return Wrong("channel '" + OneLine(std::string(word)) + "' is unknown");
      own.channels.push_back(static_cast<Channel>(known - kNames.begin()));
    }
    width_ += own.channels.size();
    return Ok();
  }

  Error ReadMotion(float longest_s) {
    float frames = 0, frame_s = 0;
    if (words_.Next() != "Frames:") return Wrong("no Frames: after MOTION");
    if (Error e = Number(&frames)) return e;
    const bool timed = words_.Next() == "Frame" && words_.Next() == "Time:";
    if (!timed) return Wrong("no Frame Time: after Frames:");
    if (Error e = Number(&frame_s)) return e;
    if (!(frames >= 1) || !(frame_s > 0)) return Wrong("no frames, or they take no time");
    const float wanted = std::min({frames, std::floor(longest_s / frame_s) + 1, kMostFrames});
    const float keys = 2 + wanted * frame_s * kKeysPerSecond;
    if (keys * static_cast<float>(skeleton_.joints.size()) > static_cast<float>(kMostPoses))
      return Wrong("its motion is too long for so many joints; cut it");
    std::vector<float> values;
    for (size_t i = 0; i < static_cast<size_t>(wanted) * width_; ++i) {
      values.push_back(0);
      if (Error e = Number(&values.back())) return e;
    }
    AddClip(values, static_cast<size_t>(wanted), frame_s);
    return Ok();
  }

  Transform TransformOf(size_t joint, const float* frame) const {
    Transform t = skeleton_.joints[joint].rest;
    const BvhJoint& own = channels_[joint];
    Vec3 moved;
    bool moves = false;
    for (size_t i = 0; i < own.channels.size(); ++i) {
      const float value = frame[own.first + i];
      const float angle = value * kPi / 180;
      switch (own.channels[i]) {
        case Channel::kX:
          moved.x = value, moves = true;
          break;
        case Channel::kY:
          moved.y = value, moves = true;
          break;
        case Channel::kZ:
          moved.z = value, moves = true;
          break;
        case Channel::kTurnX:
          t.rotation = Product(t.rotation, TurnAbout({1, 0, 0}, angle));
          break;
        case Channel::kTurnY:
          t.rotation = Product(t.rotation, TurnAbout({0, 1, 0}, angle));
          break;
        case Channel::kTurnZ:
          t.rotation = Product(t.rotation, TurnAbout({0, 0, 1}, angle));
          break;
      }
    }
    if (moves) t.translation = moved;
    return t;
  }

  void AddClip(const std::vector<float>& values, size_t frames, float frame_s) {
    Clip clip;
    clip.name = "motion";
    clip.duration_s = static_cast<float>(frames - 1) * frame_s;
    clip.keys = frames < 2 ? 1 : std::max(2, 1 + static_cast<int>(std::lround(clip.duration_s * kKeysPerSecond)));
    for (int k = 0; k < clip.keys; ++k) {
      const float at = clip.keys < 2
                           ? 0
                           : static_cast<float>(frames - 1) * static_cast<float>(k) / static_cast<float>(clip.keys - 1);
      const size_t before = std::min(static_cast<size_t>(at), frames - 1), after = std::min(before + 1, frames - 1);
      const float t = at - static_cast<float>(before);
      for (size_t j = 0; j < skeleton_.joints.size(); ++j) {
        const Transform a = TransformOf(j, values.data() + before * width_),
                        b = TransformOf(j, values.data() + after * width_);
        clip.transforms.push_back(
            {a.translation * (1 - t) + b.translation * t, Slerp(a.rotation, b.rotation, t), {1, 1, 1}});
      }
    }
    if (clip.keys == 1) clip.duration_s = 1;
    skeleton_.clips.push_back(std::move(clip));
  }

  Words words_;
  Avatar& skeleton_;
  std::vector<BvhJoint> channels_;
  size_t width_ = 0;  // numbers a frame
};

}  // namespace

Error ReadBvh(const std::filesystem::path& path, float longest_s, Avatar* skeleton) {
  std::string text;
  if (Error e = ReadTextFile(path, &text)) return e;
  *skeleton = {};
  if (Error e = BvhReader(text, skeleton).Read(longest_s)) return Fail(path.string() + ": " + e.message);
  std::vector<Mat4> world;
  for (Joint& joint : skeleton->joints) {
    const Mat4 local = FromTranslationRotationScale(joint.rest.translation, {}, {1, 1, 1});
    world.push_back(joint.parent < 0 ? local : At(world, joint.parent) * local);
    joint.inverse_bind = Inverse(world.back());
  }
  return Ok();
}

}  // namespace flaneur
