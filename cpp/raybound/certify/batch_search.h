// Searches for a whole batch of rays at once: one walk of the BVH with all that the rays pass through, and the kernels
// for eight rays at each primitive on the way. Lane by lane the answer is that of searches ray by ray.
#pragma once

#include "raybound/certify/bundle.h"
#include "raybound/certify/ray_batch.h"
#include "raybound/scene/material.h"

namespace raybound {

// Counts of rays or bundles that have searched, and of tests of a ray at a candidate.
struct SearchCounts {
    std::uint64_t searches = 0, tests = 0;
};

using BatchHits = std::array<NearestPack, batch_packs>;

// What closest hits leave open: rays that went alone, and what a ray alone finds besides its hit. `special` rays have
// found a state that is not the one they came with.
struct BatchFindings {
    RaySet alone = 0, touching = 0, special = 0;
    std::uint32_t within[batch_size];  // the solid that each ray is inside of, on its way
    float until = 0;                   // no ray has looked for hits beyond
};

constexpr int fewest = 3;  // rays that a bundle pays for

// The least box around all lanes.
Boxd box_of(const Bounds<FloatPack>& packs);

// The farthest t; infinite while a ray has hit nothing.
float farthest(std::span<const NearestPack> hits);

// The least box around those of packs [begin, end).
Boxd range(const BatchVectors& values, int begin, int end);

// Whether whole batches, and packs, are worth a bundle: until one has to be given up.
struct BatchMode {
    bool batches = true, packs = true;
};

// The closest hits of all rays, by bundles where rays are alike, else ray by ray.
void closest_hits(const Snapshot& scene, const RayBatch& rays, BatchHits& hits, BatchMode& mode, SearchCounts& counts,
                  BatchFindings& findings);

// The same for one ray of the batch, alone.
void search_alone(const Snapshot& scene, const RayBatch& rays, int index, BatchHits& hits, BatchFindings& findings);

// Where rays to a light begin, and what they know.
struct ShadowOrigins {
    BatchVectors origin;
    BatchStates states;
};

// Which of the rays to a light are blocked by the solid that they are within.
RaySet blocked_from_inside(const Snapshot& scene, const ShadowOrigins& from, const Light& light, RaySet rays);

// Which lanes of a pack of such rays another primitive blocks.
std::uint32_t blocked_lanes(const Snapshot& scene, const ShadowOrigins& from, const RayPack& rays, int pack,
                            std::uint32_t primitive, std::uint32_t lanes);

// A patch that holds the origins of some of the rays (one at least).
Patch patch_around(const ShadowOrigins& from, RaySet rays);

// The rays from a pack's origins to a light.
RayPack shadow_rays(const ShadowOrigins& from, const Light& light, int pack);

// Which of the rays to a light are blocked: those side by side together. `reach` tells how far apart the origins of one
// bundle may be; `last` is a primitive to ask first, and is told which one has blocked.
RaySet blocked_rays(const Snapshot& scene, const ShadowOrigins& from, const Light& light, RaySet rays, float reach,
                    std::uint32_t& last, SearchCounts& counts);

}  // namespace raybound
