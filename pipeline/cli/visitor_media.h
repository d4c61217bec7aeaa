// The sounds and pictures that tour.toml names, as the pack carries them; and what is spoken by machine. Internal to
// pipeline/cli.
#pragma once
#include <filesystem>

#include "pipeline/cli/tour_settings.h"
#include "pipeline/core/store.h"
#include "pipeline/pack/write_tour_pack.h"

namespace flaneur {

inline constexpr int kMaxPictureSide_px = 1024;  // of a hotspot

// Into parts->sounds and ->pictures, each file once, and what stops, hotspots and sound places are to play. Texts that
// are to be spoken and have no file are, by espeak-ng; `store` keeps that for the next bake. Errors: a file that is no
// sound or picture, a voice that espeak-ng does not know; each names the file or the text.
Error MakeVisitorMedia(const TourSettings& settings, const Store& store, TourParts* parts);

}  // namespace flaneur
