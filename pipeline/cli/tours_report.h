// One report over many tours. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <vector>

#include "pipeline/cli/bake.h"
#include "runtime/base/error.h"

namespace flaneur {

// folder/report.html and folder/report.json: for each tour how it went, what it took, and where its own report is.
Error WriteToursReport(const std::filesystem::path& folder, const std::vector<BakedTour>& baked);

}  // namespace flaneur
