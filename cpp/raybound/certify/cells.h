// Surface cells: for parts of faces, and for each light, what may block it. Found when they are asked for, kept across
// frames and edits, shared by all threads.
//
// A cell is a certificate about rays, not about surfaces: that of its patch's points toward the light, but for the one
// primitive that they have left, none is blocked by anything that is not in its list. Whoever asks shows that an origin
// lies in the patch.
#pragma once

#include <span>

#include "raybound/certify/arena.h"
#include "raybound/certify/bundle.h"
#include "raybound/certify/chart.h"
#include "raybound/certify/image_blocks.h"
#include "raybound/trace/search.h"

namespace raybound {

struct CellCounts {
    std::uint64_t made = 0, lit = 0, blocked = 0, listed = 0, refused = 0;  // verdicts of one light each

    CellCounts& operator+=(const CellCounts& o) {
        made += o.made, lit += o.lit, blocked += o.blocked, listed += o.listed, refused += o.refused;
        return *this;
    }
};

enum class CellVerdict : std::uint8_t { none, lit, blocked, list };
enum class NoCell : std::uint8_t { unsupported, cost, memory, crowded };
inline constexpr std::size_t no_cell_reasons = 4;

struct CellAnswer {
    CellVerdict verdict = CellVerdict::none;
    NoCell why = NoCell::unsupported;           // there is no verdict
    std::span<const std::uint32_t> candidates;  // primitives that may block; for `blocked` the one that does
    ChartCell cell{};                           // for whose points the answer holds
};

// A place where rays to lights begin: one side of one piece of a face.
struct FaceKey {
    std::uint32_t primitive = 0, leaf = 0;
    std::int32_t face = 0, face_offset = 0;
    int piece = 0;
    bool outward = true;
    std::uint32_t departed = Departure::none;  // the primitive that the rays have left, or none

    bool operator==(const FaceKey&) const = default;
};

class Cells {
  public:
    // At most so many bytes; half of them for `blocks()`, if what they have met is kept, too.
    explicit Cells(std::size_t memory, bool keeps_blocks = true) : memory_(memory), keeps_blocks_(keeps_blocks) {}

    // Follows the scene to a snapshot, and makes room. Not while anybody asks.
    void begin_frame(const Snapshot& scene);
    void clear();

    std::size_t bytes() const;  // of cells and blocks
    std::size_t count() const { return cells_; }

    ImageBlocks& blocks() { return blocks_; }
    const ImageBlocks& blocks() const { return blocks_; }

    // One cell for pictures: where it is, and its verdicts by light.
    struct View {
        std::int32_t object, face;
        int piece, depth;
        bool outward, leaf;
        ChartRectangle rectangle;
        Patch patch;
        std::vector<std::int32_t> candidates;  // by light: -2 unknown, -1 blocked, else the length of the list
    };
    std::vector<View> views(const Snapshot& scene, std::int32_t object) const;
    // The smallest cell of an object's face around a point.
    std::optional<View> view_at(const Snapshot& scene, std::int32_t object, std::int32_t face,
                                const Vec3d& point) const;

  private:
    friend class FaceCells;
    struct Slot {
        std::int32_t id = -1;
        LightPointer light;
    };

    static constexpr std::uint32_t cell_words_without_lights = 2;  // children; siblings and itself, whether used
    static constexpr std::uint32_t ways_shift = 1;
    std::uint32_t cell_words() const { return cell_words_without_lights + std::uint32_t(slots_.size()); }
    std::uint32_t roots_of(const Snapshot& scene, std::uint32_t primitive);
    std::uint32_t root_count(const Snapshot& scene, std::uint32_t primitive) const;

    // The cells that a word leads to, made if there are none; none if there is no memory.
    std::uint32_t make_cells(std::uint32_t word, int ways);
    void touch(std::uint32_t cell) {
        const auto used = arena_.word(cell + 1);
        const std::uint32_t word = used.load(std::memory_order_relaxed);
        if ((word & 1) == 0) used.store(word | 1, std::memory_order_relaxed);
    }

    bool follow(const Snapshot& scene);
    void follow_lights(const Snapshot& scene);
    bool follow_objects(const Snapshot& scene);
    void forget(std::uint32_t first, const std::vector<bool>& stale);
    void update_cell(const Snapshot& scene, const Chart& chart, const ChartRectangle& rectangle, std::uint32_t cell,
                     const SceneChange& change, std::vector<bool> touched);
    void update_entry(const Snapshot& scene, const Bundle& bundle, std::uint32_t word, const SceneChange& change,
                      bool touched);
    void make_room(const Snapshot& scene);
    bool sweep(std::uint32_t word);
    template <class Visit>
    void visit_roots(const Snapshot& scene, const Visit& visit) const;
    void add_views(const FaceKey& key, const Chart& chart, const ChartRectangle& rectangle, std::uint32_t cell,
                   int depth, std::int32_t object, std::vector<View>& found) const;
    void release_entry(std::uint32_t word);
    void release_cells(std::uint32_t first);
    void release_tree(std::uint32_t roots, std::uint32_t count);

    void begin_anew(const Snapshot& scene);

    std::size_t memory_, most_primitives_ = 0;
    bool keeps_blocks_;
    ImageBlocks blocks_;
    Arena arena_;
    std::vector<std::uint32_t> roots_;     // by primitive: a record of root cells by face, piece and side
    std::vector<Box> bounds_;              // of primitives
    std::atomic<std::size_t> tables_ = 0;  // bytes of these two
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> slot_of_light_;
    ContentPointer content_;
    std::atomic<std::size_t> cells_ = 0;
};

}  // namespace raybound
