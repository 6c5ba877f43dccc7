// What ExactTracer knows of one batch at one depth of the ray tree.
#pragma once

#include <algorithm>

#include "raybound/certify/exact_tracer.h"
#include "raybound/shapes/lanes.h"

namespace raybound {

// What several rays of a batch hit: one side of one face.
struct ExactTracer::Face {
    std::uint32_t primitive = 0, leaf = 0;
    std::int32_t face = 0, face_offset = 0;
    bool entering = false;
    std::uint32_t outer = 0;  // what rays that leave on the viewer's side have left for good
    std::int32_t object = -1;
    const Material* material = nullptr;
    RaySet rays = 0;
};

// The cells of a piece of a face that was seen in this tile, with what they have told of lights; and where in its chart
// the rays of the batch begin.
struct ExactTracer::Piece {
    FaceCells cells;
    std::uint64_t tile, batch = 0;
    std::vector<CellAnswer> answers;  // by light: the last ones
    std::uint32_t packs = 0;          // of the batch, whose points are known
    std::array<Vec3<DoublePack>, batch_packs> points{};

    Vec3d point(int index) const { return lane_of(points[std::size_t(index / pack_width)], index % pack_width); }
};

// What one depth of the ray tree knows of its batch, ray by ray; not on the stack: trees may be a thousand deep.
struct ExactTracer::Level {
    int depth = 1;
    BatchHits hits;
    std::vector<Face> faces;
    std::uint8_t face_of[batch_size];

    BatchVectors point, point_error, normal, shading, view, diffuse, side, sum;
    ShadowOrigins outside;
    BatchFloats t, way;  // from the ray's origin, and from the eye
    RaySet entering = 0, hit = 0;
    BatchFindings found;
    BatchFloats outside_ior;

    struct LightValue {
        BatchVectors value;                                   // what it adds where it is not blocked
        RaySet rays = 0;                                      // for which it may
        RaySet asked = 0, blocked = 0;                        // rays of which it is known whether they see it, or not
        std::array<RaySet, no_cell_reasons> without_cells{};  // of those, for which cells did not do, by why

        void forget() {
            rays = asked = blocked = 0;
            without_cells = {};
        }
    };
    std::vector<LightValue> lights;

    // The rays that are sent on, reflected and refracted ones apart; by their own numbers.
    struct Spawned {
        BatchVectors weight_of_hit, direction_of_hit;
        RayBatch rays;
        std::uint8_t parent[batch_size];
        BatchVectors weight;
    };
    Spawned reflected, refracted;
    BatchRadiance seen;

    // What is kept of these rays, if it holds, and where what is kept next is written.
    const std::uint64_t *kept = nullptr, *kept_lights = nullptr;
    record::Batch kept_batch;
    bool same_ior = false;  // as when it was written
    std::size_t written = 0;

    void add(const Face& face) {
        for (RaySet rest = face.rays; rest != 0;) face_of[take_first(rest)] = std::uint8_t(faces.size());
        faces.push_back(face);
    }

    // Calls visit(material, rays) for the hits of each material together.
    template <class Visit>
    void visit_materials(const Visit& visit) const {
        for (RaySet open = hit; open != 0;) {
            const Material* material = faces[face_of[std::countr_zero(open)]].material;
            RaySet same = 0;
            for (const Face& face : faces)
                if (face.material == material) same |= face.rays;
            visit(*material, same);
            open &= ~same;
        }
    }
};

inline void mark(Searched& searched, Searched why) {
    if (searched == Searched::no) searched = why;
}

}  // namespace raybound
