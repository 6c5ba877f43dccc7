// The base tracer's picture from certified lists: batches of rays instead of single ones, surface cells instead of
// shadow searches, eight points side by side. Every bit of it is the base tracer's, whatever the cells know.
#pragma once

#include "raybound/certify/batch_search.h"
#include "raybound/certify/block_record.h"
#include "raybound/certify/face_cells.h"
#include "raybound/trace/local_light.h"
#include "raybound/trace/tracer.h"

namespace raybound {

// What one thread has done: searches of the scene by kind (bundles count once), tests of candidates instead, verdicts.
struct ExactCounts {
    RayCounts rays;
    std::uint64_t tests = 0;
    CellCounts cells;

    ExactCounts& operator+=(const ExactCounts& o) {
        rays += o.rays, tests += o.tests, cells += o.cells;
        return *this;
    }
};

struct ExactSettings {
    int max_depth = 5;
    double pixel_angle = 0;  // how fast a pixel's width grows with the distance
    CellPolicy policy;
    const std::atomic<bool>* cancelled = nullptr;
};

// One for each thread.
class ExactTracer {
  public:
    ExactTracer(const Snapshot& scene, Cells& cells, const ExactSettings& settings);
    ExactTracer(ExactTracer&&) noexcept;
    ~ExactTracer();

    // What has been learnt about rays is forgotten: no tile's paths and counts depend on what was done before.
    void begin_tile();

    // Traces the eye rays of a batch; `kept` is what the same rays met before.
    void trace_eye(const RayBatch& rays, const ImageBlocks::Kept& kept, BatchRadiance& out);

    // What they have met now, if blocks are to be kept.
    std::span<const std::uint64_t> written() const { return written_; }

    const ExactCounts& counts() const { return counts_; }

  private:
    struct Face;
    struct Piece;
    struct Level;

    Level& level_at(int depth);
    void trace(const RayBatch& rays, int depth, std::uint64_t RayCounts::* kind, const std::uint64_t* kept,
               BatchRadiance& out);
    void search(const RayBatch& rays, std::uint64_t RayCounts::* kind, Level& level);
    void find_faces(const RayBatch& rays, Level& level);
    void meet_face(const RayBatch& rays, Level& level, Face& face);
    UV<FloatPack> meet_pack(const RayBatch& rays, Level& level, const Face& face, const std::uint8_t* index, int count);
    void weigh_lights(Level& level, const Material& material, RaySet rays);
    void add_lights(Level& level, int packs) const;
    void settle_shadows(Level& level, std::size_t light, BatchRadiance& out);
    void search_shadows(Level& level, std::size_t light, RaySet all);
    RaySet ask_cells(Level& level, const Face& face, std::size_t light, RaySet open);
    Piece& piece_at(const Level& level, const Face& face, int index);
    const CellAnswer& ask(const Level& level, Piece& piece, std::size_t light, int index);
    void test_candidates(Level& level, std::size_t light, RaySet rays, const CellAnswer& answer);
    void add_secondary(Level& level, BatchRadiance& out);
    void spawn(Level& level, const Material& material, RaySet hits);
    void collect(Level& level, bool reflected);
    void complete(Face& face) const;
    Departures departures_of(const Level& level, const Face& face, int ray) const;
    void find_outside(Level& level) const;

    // Records of blocks (exact_records.cpp).
    bool recall(const RayBatch& rays, const std::uint64_t* kept, Level& level);
    void recall_states(const RayBatch& rays, RaySet special, Level& level) const;
    bool recall_face(const record::Face& from, Face& to) const;
    void recall_lights(Level& level);
    void write(Level& level);
    const std::uint64_t* kept_tree(const Level& level, bool reflected) const;
    void write_tree(Level& level, bool reflected);

    const Snapshot& scene_;
    Cells& cells_;
    ExactSettings settings_;
    ExactCounts counts_;
    BatchMode eye_mode_;  // batches that were given up are not tried again in a tile, packs in a block
    std::vector<std::unique_ptr<Level>> levels_;  // of the ray tree, made when they are first reached
    std::vector<std::uint32_t> last_blockers_;    // by light
    std::vector<std::optional<Piece>> pieces_;    // of faces seen in this tile, by a hash of their keys
    std::uint64_t tile_ = 0, batch_ = 0;          // numbers of those at hand
    std::span<const SceneChange> changes_;        // since what is kept was written
    record::Words written_;
    bool writes_ = false;
};

}  // namespace raybound
