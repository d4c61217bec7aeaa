// The verbs of `flaneur`, one file each. args: what follows the verb. Exit status: 0 done, 1 findings, 2 bad usage or
// input.
#pragma once
#include <string>
#include <vector>

namespace flaneur {

using Arguments = std::vector<std::string>;

int RunAvatar(const Arguments& args);
int RunBake(const Arguments& args);
int RunCache(const Arguments& args);
int RunCheck(const Arguments& args);
int RunFootprints(const Arguments& args);
int RunImpostor(const Arguments& args);
int RunInspect(const Arguments& args);
int RunPlan(const Arguments& args);
int RunStep(const Arguments& args);
int RunWeb(const Arguments& args);

}  // namespace flaneur
