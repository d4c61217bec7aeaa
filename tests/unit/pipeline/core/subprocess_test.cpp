#include "pipeline/core/blender.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <functional>
#include <optional>
#include <thread>

#include "pipeline/core/subprocess.h"
#include "pipeline/core/temporary_folder.h"
#include "runtime/base/file.h"

// In place of the C library's: slow where a test asks for it, as on a machine that is busy.
extern "C" ssize_t send(int socket, const void* data, size_t size, int flags) {
  if (std::getenv("FLANEUR_TEST_SLOW_SEND")) ::usleep(500'000);
  return ::syscall(SYS_sendto, socket, data, size, flags, nullptr, 0);
}

namespace flaneur {
namespace {

namespace fs = std::filesystem;

// Sets an environment variable for a test's duration.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

class Subprocess : public testing::Test {
 protected:
  void SetUp() override { ASSERT_FALSE(folder_.Create("flaneur_test_")); }

  // A program that stands in for Blender and says what a script would.
  fs::path Program(const std::string& body) {
    const fs::path path = folder_.path() / "program";
    EXPECT_FALSE(WriteTextFile(path, "#!/bin/sh\n" + body + "\n"));
    fs::permissions(path, fs::perms::owner_all);
    return path;
  }

  Error RunWith(const std::string& body) {
    const Variable blender("FLANEUR_BLENDER", Program(body).string());
    const Variable scripts("FLANEUR_BLENDER_SCRIPTS", folder_.path().string());
    EXPECT_FALSE(WriteTextFile(folder_.path() / "script.py", ""));
    BlenderOptions options;
    options.log_file = folder_.path() / "log.txt";
    return RunBlenderScript("script.py", "{\"seed\": 1}", options, &result_);
  }

  std::string Log() {
    std::string text;
    EXPECT_FALSE(ReadTextFile(folder_.path() / "log.txt", &text));
    return text;
  }

  TemporaryFolder folder_;
  ProcessResult result_;
};

TEST_F(Subprocess, ArgumentsArriveAsGiven) {
  RunOptions options;
  options.log_file = folder_.path() / "log.txt";
  ASSERT_FALSE(RunProcess({"printf", "%s|", "a b", "$HOME", "*", ""}, options, &result_));
  EXPECT_EQ(result_.exit_status, 0);
  EXPECT_EQ(Log(), "a b|$HOME|*||");
}

TEST_F(Subprocess, TellsHowItEnded) {
  ASSERT_FALSE(RunProcess({"sh", "-c", "exit 7"}, {}, &result_));
  EXPECT_EQ(result_.exit_status, 7);
  ASSERT_FALSE(RunProcess({"sh", "-c", "kill -9 $$"}, {}, &result_));
  EXPECT_EQ(result_.exit_status, 128 + 9);
  EXPECT_GT(result_.peak_memory_bytes, 0);
}

TEST_F(Subprocess, WhoPrintsForeverIsStopped) {
  RunOptions options;
  options.log_file = folder_.path() / "log.txt";
  const Error error = RunProcess({"yes", std::string(10000, 'y')}, options, &result_);
  EXPECT_NE(error.message.find("after it had printed 256 MiB"), std::string::npos) << error.message;
  std::filesystem::remove(options.log_file);
}

TEST_F(Subprocess, MissingProgramIsNamed) {
  const Error error = RunProcess({"flaneur-no-such-program"}, {}, &result_);
  EXPECT_NE(error.message.find("flaneur-no-such-program"), std::string::npos);
}

TEST_F(Subprocess, EnvironmentIsReplacedNotDoubled) {
  const Variable old("FLANEUR_TEST_VARIABLE", "old");
  RunOptions options;
  options.log_file = folder_.path() / "log.txt";
  options.environment = {"FLANEUR_TEST_VARIABLE=new"};
  ASSERT_FALSE(RunProcess({"env"}, options, &result_));
  EXPECT_NE(Log().find("FLANEUR_TEST_VARIABLE=new"), std::string::npos);
  EXPECT_EQ(Log().find("FLANEUR_TEST_VARIABLE=old"), std::string::npos);
}

TEST_F(Subprocess, BlenderNotFoundSaysWhatToDo) {
  const Variable none("FLANEUR_BLENDER", "");
  const Variable path("PATH", folder_.path().string());
  fs::path program;
  EXPECT_EQ(FindBlender(&program).message,
            "Blender not found: install the Debian package blender or set FLANEUR_BLENDER");
}

TEST_F(Subprocess, WronglyNamedBlenderIsNotReplacedBySilentFallback) {
  const Variable wrong("FLANEUR_BLENDER", (folder_.path() / "nowhere").string());
  fs::path program;
  EXPECT_NE(FindBlender(&program).message.find("nowhere"), std::string::npos);
}

TEST_F(Subprocess, ScriptGetsItsSettingsAfterTheDashes) {
  ASSERT_FALSE(RunWith("for last; do :; done; echo \"$@\"; cat \"$last\""));
  EXPECT_NE(Log().find("--background --factory-startup --python-exit-code 1"), std::string::npos);
  EXPECT_NE(Log().find("{\"seed\": 1}"), std::string::npos);
}

TEST_F(Subprocess, ScriptsOwnErrorLineIsTheError) {
  const Error error = RunWith("echo before; echo 'flaneur: error: the roof leaks' >&2; echo Quit; exit 1");
  EXPECT_EQ(error.message.rfind("script.py: the roof leaks", 0), 0u) << error.message;
}

TEST_F(Subprocess, PythonExceptionIsTheErrorWhereNothingBetterWasSaid) {
  const Error error = RunWith("echo 'KeyError: 42'; echo 'Error: script failed'; echo; exit 1");
  EXPECT_EQ(error.message.rfind("script.py: KeyError: 42", 0), 0u) << error.message;
}

TEST_F(Subprocess, MissingScriptIsNamed) {
  const Variable blender("FLANEUR_BLENDER", Program("exit 0").string());
  const Error error = RunBlenderScript("no_such_script.py", "{}", {}, nullptr);
  EXPECT_NE(error.message.find("no_such_script.py"), std::string::npos);
}

bool Within10s(const std::function<bool()>& is_so) {
  for (int i = 0; i < 1000 && !is_so(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return is_so();
}

// Whoever starts a program and is killed the moment that it runs.
TEST_F(Subprocess, EndsWithWhoStartedItHoweverSoonThatIsKilled) {
  if (const char* program = std::getenv("FLANEUR_TEST_PROGRAM")) {  // in the process that the test starts below
    ProcessResult result;
    EXPECT_FALSE(RunProcess({program}, {}, &result));
    return;
  }
  const fs::path marker = folder_.path() / "marker";
  const fs::path program = Program("sleep 60 &\necho $! > " + marker.string() + ".new\nmv " + marker.string() +
                                   ".new " + marker.string() + "\nwait");
  const Variable told("FLANEUR_TEST_PROGRAM", program.string()), slow("FLANEUR_TEST_SLOW_SEND", "1"),
      temporary("TMPDIR", folder_.path().string());
  const pid_t owner = ::fork();
  if (owner == 0) {
    ::execl("/proc/self/exe", "self", "--gtest_filter=Subprocess.EndsWithWhoStartedIt*", nullptr);
    ::_exit(127);
  }
  ASSERT_TRUE(Within10s([&] { return fs::exists(marker); }));
  ::kill(owner, SIGKILL);
  ASSERT_EQ(::waitpid(owner, nullptr, 0), owner);
  std::string text;
  ASSERT_FALSE(ReadTextFile(marker, &text));
  const auto sleeper = static_cast<pid_t>(std::stol(text));
  const auto is_gone = [&] {
    std::string stat;
    return ReadTextFile("/proc/" + std::to_string(sleeper) + "/stat", &stat) || stat.find(") Z ") != std::string::npos;
  };
  EXPECT_TRUE(Within10s(is_gone)) << "started by what was started, and left alone";
  if (!is_gone()) ::kill(sleeper, SIGKILL);
}

TEST(TemporaryFolderTest, IsGoneWithItsContents) {
  fs::path path;
  {
    TemporaryFolder folder;
    ASSERT_FALSE(folder.Create("flaneur_test_"));
    path = folder.path();
    ASSERT_FALSE(WriteTextFile(path / "a" / "b.txt", "x"));
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace flaneur
