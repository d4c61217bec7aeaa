// A person put together from several files on one skeleton: body, outfit, hair.
#pragma once
#include "pipeline/io/gltf_document.h"
#include "runtime/base/error.h"

namespace flaneur {

// Adds what `part` shows to `whole`. Its bones are those of `whole` that have their names; bones of its own (skirts,
// braids) come along on them. Its clips are left. Errors: most of its bones have no counterpart; names the file.
Error JoinDocuments(GltfDocument part, GltfDocument* whole);

// Puts skeletons together that stand in one another, as pieces of an outfit bring each its own: what is bound to one of
// them goes with the bones of the same names of the one that clips move most, or that has the most. Bones that it lacks
// come along on them.
void JoinTwins(GltfDocument* document);

}  // namespace flaneur
