// What the extension tells visitors: texts by language, sounds, hotspots, streets. Internal to runtime/pack.
#pragma once
#include "runtime/pack/tour_object.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

// By language; empty where there are none.
TextsByLanguage ReadTranslations(const TourObject& json, const char* key);

// The member `sounds`, by language; their files go to the pack.
std::map<std::string, StopSound> ReadSounds(const GltfFile& file, const TourObject& json, TourPack* pack);

// Hotspots, streets, places that sound, the photo's line. Packs without them have none.
void ReadVisitorData(const GltfFile& file, const TourObject& tour, TourPack* pack);

}  // namespace flaneur
