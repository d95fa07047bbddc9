// The target reads its input as a script of calls of the C interface. Each call takes a byte that
// names the function, and its arguments from the bytes behind it: handles by their slot (one of
// eight is NULL, one of eight is a handle of another kind), numbers as they come, buffers of any
// size. After each call
//   - the status is one of the documented ones, and a refusal has words;
//   - each chunk is still canonical: its raw bytes are read by runstone_runs.h and decode to an equal
//     chunk;
//   - a mesh that was updated has the quads of a new one.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "bindings/c/runstone.h"
#include "bindings/c/runstone_runs.h"

namespace {

constexpr std::size_t kSlots = 3;
constexpr std::size_t kCallsMax = 64;

[[noreturn]] void broken(const char* what) {
  std::fprintf(stderr, "c_abi_fuzz: %s (%s)\n", what, runstone_last_error());
  std::abort();
}
void require(bool holds, const char* what) {
  if (!holds) broken(what);
}

class ScriptBytes {
 public:
  explicit ScriptBytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool empty() const { return bytes_.empty(); }
  std::uint8_t byte() {
    if (bytes_.empty()) return 0;
    const std::uint8_t next = bytes_.front();
    bytes_ = bytes_.subspan(1);
    return next;
  }
  std::uint32_t number() {
    std::uint32_t out = 0;
    for (int i = 0; i < 4; ++i) out = out << 8 | byte();
    return out;
  }
  /// Mostly a small number with a sign.
  std::int32_t place() {
    const std::uint8_t first = byte();
    if (first == 255) return static_cast<std::int32_t>(number());
    return static_cast<std::int32_t>(first) - 100;
  }
  /// Mostly a side that a chunk can have.
  std::uint32_t side() {
    static constexpr std::array<std::uint32_t, 8> kSides = {16, 16, 16, 8, 32, 4, 256, 9};
    return kSides[byte() % kSides.size()];
  }
  std::span<const std::uint8_t> take(std::size_t most) {
    const auto out = bytes_.first(std::min(most, bytes_.size()));
    bytes_ = bytes_.subspan(out.size());
    return out;
  }
  /// A number of any kind: infinite, none, huge or small.
  double real() {
    static constexpr std::array<double, 4> kOdd = {1e300, -1e-300, 1e9, -257};
    const std::uint8_t first = byte();
    if (first >= 252) return kOdd[first - 252U];
    if (first == 251) return std::strtod("nan", nullptr);
    if (first == 250) return std::strtod("inf", nullptr);
    return (static_cast<double>(first) - 100) / 4;
  }
  runstone_vec vec() {
    const double x = real(), y = real();
    return {x, y, real()};
  }
  runstone_pos pos() {
    const std::int32_t x = place(), y = place();
    return {x, y, place()};
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

template <class T>
using Slots = std::array<T*, kSlots>;

class CallScript {
 public:
  explicit CallScript(std::span<const std::uint8_t> bytes) : in_(bytes) {}
  CallScript(const CallScript&) = delete;
  CallScript& operator=(const CallScript&) = delete;
  ~CallScript() {
    for (std::size_t i = 0; i < kSlots; ++i) {
      require(runstone_mesh_free(meshes_[i]) == RUNSTONE_OK, "a mesh is not freed");
      require(runstone_borders_free(borders_[i]) == RUNSTONE_OK, "borders are not freed");
      require(runstone_visibility_free(tables_[i]) == RUNSTONE_OK, "a table is not freed");
      require(runstone_edits_free(edits_[i]) == RUNSTONE_OK, "edits are not freed");
      require(runstone_space_free(spaces_[i]) == RUNSTONE_OK, "a space is not freed");
      require(runstone_chunk_free(chunks_[i]) == RUNSTONE_OK, "a chunk is not freed");
    }
  }

  void run() {
    for (std::size_t call = 0; call < kCallsMax && !in_.empty(); ++call) {
      const runstone_status status = step(in_.byte());
      require(status >= RUNSTONE_OK && status < RUNSTONE_NO_MEMORY, "an undocumented status");
      require(status == RUNSTONE_OK || runstone_last_error()[0] != '\0', "a refusal without words");
      for (const runstone_chunk* chunk : chunks_) {
        if (chunk != nullptr) check_chunk(chunk);
      }
    }
  }

 private:
  /// A handle of a slot, NULL, or one of another kind.
  template <class T>
  T* pick(const Slots<T>& slots) {
    const std::uint8_t choice = in_.byte();
    if (choice % 8 == 7) return nullptr;
    if (choice % 8 == 6) {
      for (const auto* handle : chunks_) {
        if (handle != nullptr && static_cast<const void*>(&slots) != &chunks_)
          return reinterpret_cast<T*>(const_cast<runstone_chunk*>(handle));
      }
      return nullptr;
    }
    return slots[choice % kSlots];
  }

  /// Makes a new handle in a slot. What was there is freed.
  template <class T, class Create, class Free>
  runstone_status renew(Slots<T>& slots, Create&& create, Free&& free) {
    T*& slot = slots[in_.byte() % kSlots];
    T* made = nullptr;
    const runstone_status status = create(&made);
    require((made != nullptr) == (status == RUNSTONE_OK), "an output of a refused call");
    if (status != RUNSTONE_OK) return status;
    require(free(slot) == RUNSTONE_OK, "a handle is not freed");
    slot = made;
    return status;
  }
  template <class Create>
  runstone_status renew_chunk(Create&& create) {
    return renew(chunks_, create, runstone_chunk_free);
  }

  runstone_brush brush() {
    runstone_brush out{};
    out.struct_size = in_.byte() == 255 ? in_.byte() : sizeof out;
    out.mask = in_.byte() % 5U;
    out.mask_material = out.mask == 3 ? in_.byte() : 0;
    out.material = in_.byte() % 4;
    return out;
  }

  runstone_status step(std::uint8_t which) {
    switch (which % 6) {
      case 0:
        return make(which / 6U);
      case 1:
        return change(which / 6U);
      case 2:
        return add(which / 6U);
      case 3:
        return read(which / 6U);
      case 4:
        return mesh(which / 6U);
      default:
        return collide(which / 6U);
    }
  }

  runstone_status make(unsigned which) {
    const std::uint32_t x = in_.side(), y = in_.byte() < 200 ? x : in_.side();
    switch (which % 8) {
      case 0:
        return renew_chunk(
            [&](auto** out) { return runstone_chunk_create_filled(x, y, x, in_.byte() % 4, out); });
      case 1: {
        std::vector<std::uint16_t> voxels;
        for (const std::uint8_t byte : in_.take(16)) voxels.push_back(byte % 4);
        const std::size_t volume = x <= 32 && y <= 32 ? std::size_t{x} * y * x : 1;
        if (voxels.empty()) voxels.push_back(0);
        while (voxels.size() < volume) voxels.push_back(voxels[voxels.size() / 3]);
        const std::uint32_t order = in_.byte() % 7U;
        return renew_chunk([&](auto** out) {
          return runstone_chunk_create_from_array(x, y, x, order, voxels.data(), voxels.size(),
                                                  out);
        });
      }
      case 2: {
        std::vector<std::uint32_t> ends;
        std::vector<std::uint16_t> materials;
        for (unsigned i = in_.byte() % 9U; i > 0; --i) {
          ends.push_back((ends.empty() ? 0 : ends.back()) + in_.byte() * 16U);
          materials.push_back(in_.byte() % 4);
        }
        ends.push_back(in_.byte() == 255 ? in_.number() : x * y * x);
        materials.push_back(in_.byte() % 4);
        const std::uint32_t order = in_.byte() % 7U;
        return renew_chunk([&](auto** out) {
          return runstone_chunk_create_from_runs(x, y, x, order, ends.data(), materials.data(),
                                                 ends.size(), out);
        });
      }
      case 3: {
        const auto bytes = in_.take(in_.byte());
        const std::uint32_t sides[3] = {x, y, x};
        const bool any = in_.byte() % 2 == 0;
        return renew_chunk([&](auto** out) {
          return runstone_chunk_decode(bytes.data(), bytes.size(), any ? nullptr : sides, out);
        });
      }
      case 4:
        return renew(edits_, runstone_edits_create, runstone_edits_free);
      case 5: {
        const auto kinds = in_.take(4);
        if (in_.byte() % 4 == 3) return make_shaped(kinds);
        return renew(
            tables_,
            [&](auto** out) { return runstone_visibility_create(kinds.data(), kinds.size(), out); },
            runstone_visibility_free);
      }
      case 6:
        return renew(
            spaces_, [&](auto** out) { return runstone_space_create(x, out); },
            runstone_space_free);
      default:
        return renew(meshes_, runstone_mesh_create, runstone_mesh_free);
    }
  }

  /// Makes a table in which material 1 may have a shape of boxes as they come.
  runstone_status make_shaped(std::span<const std::uint8_t> kinds) {
    runstone_shapes* shapes = nullptr;
    require(runstone_shapes_create(&shapes) == RUNSTONE_OK, "shapes are not made");
    const std::uint8_t form = in_.byte();
    std::vector<runstone_local_box> boxes(in_.byte() % 40U);
    for (runstone_local_box& box : boxes) {
      const auto bytes = in_.take(6);
      std::copy_n(bytes.begin(), std::min<std::size_t>(bytes.size(), 3), box.min);
      for (std::size_t i = 3; i < bytes.size(); ++i) box.max[i - 3] = bytes[i];
    }
    const runstone_status added =
        runstone_shapes_add(shapes, 1, form % 3U, boxes.data(), boxes.size());
    const runstone_status made = renew(
        tables_,
        [&](auto** out) {
          return runstone_visibility_create_with_shapes(kinds.data(), kinds.size(), shapes, out);
        },
        runstone_visibility_free);
    require(runstone_shapes_free(shapes) == RUNSTONE_OK, "shapes are not freed");
    return made == RUNSTONE_OK ? added : made;
  }

  runstone_status change(unsigned which) {
    runstone_chunk* const chunk = pick(chunks_);
    switch (which % 6) {
      case 0: {
        const std::uint32_t first = in_.byte() * 8U, voxels = in_.byte();
        return runstone_chunk_fill(chunk, first, voxels, in_.byte() % 4);
      }
      case 1:
        return runstone_chunk_reorder(chunk, in_.byte() % 8U);
      case 2: {
        runstone_changes changes{};
        changes.struct_size = in_.byte() == 255 ? 7 : sizeof changes;
        const runstone_pos at = {in_.place() / 100, in_.place() / 100, in_.place() / 100};
        return runstone_chunk_apply(chunk, at, pick(edits_), &changes);
      }
      case 3:
        return renew_chunk([&](auto** out) { return runstone_chunk_clone(chunk, out); });
      case 4:
        return runstone_tile_veil(chunk, pick(tables_));
      default: {
        std::array<const runstone_chunk*, 8> children{};
        for (auto& child : children) child = pick(chunks_);
        const std::uint32_t edge = in_.side(), order = in_.byte() % 7U;
        const runstone_visibility* table = pick(tables_);
        return renew_chunk([&](auto** out) {
          return runstone_tile_build(children.data(), edge, order, table, out);
        });
      }
    }
  }

  runstone_status add(unsigned which) {
    const runstone_brush with = brush();
    runstone_edits* to = pick(edits_);
    switch (which % 6) {
      case 0:
        return runstone_edits_add_voxel(to, in_.pos(), &with);
      case 1: {
        const runstone_pos min = in_.pos();
        return runstone_edits_add_box(to, {min, in_.pos()}, &with);
      }
      case 2: {
        const runstone_pos centre = in_.pos();
        return runstone_edits_add_sphere(to, centre, in_.byte() % 20U, &with);
      }
      case 3: {
        std::vector<runstone_pos> points(in_.byte() % 5U + 1);
        for (runstone_pos& point : points) point = in_.pos();
        return runstone_edits_add_stroke(to, points.data(), points.size(), in_.byte() % 9U, &with);
      }
      case 4: {
        const auto bytes = in_.take(in_.byte());
        return runstone_edits_add_bytes(to, bytes.data(), bytes.size());
      }
      default:
        return runstone_edits_clear(to);
    }
  }

  runstone_status read(unsigned which) {
    const runstone_chunk* const chunk = pick(chunks_);
    const runstone_edits* const edits = pick(edits_);
    const std::uint8_t choice = in_.byte(), room = in_.byte();
    std::size_t count = 0;
    switch (which % 7) {
      case 0: {
        std::vector<std::uint8_t> out(room * 4U);
        return runstone_chunk_encode(chunk, choice % 5U, out.data(), out.size(), &count);
      }
      case 1: {
        std::vector<std::uint16_t> out(room * 64U);
        return runstone_chunk_to_array(chunk, choice % 7U, out.data(), out.size(), &count);
      }
      case 2: {
        std::uint16_t material = 0;
        return runstone_chunk_get(chunk, choice, room, room / 2U, &material);
      }
      case 3: {
        std::uint32_t is_equal = 0;
        return runstone_chunk_equal(chunk, pick(chunks_), &is_equal);
      }
      case 4: {
        std::vector<runstone_pos> out(room);
        return runstone_edits_touched_chunks(edits, choice % 4U, in_.side(), out.data(), out.size(),
                                             &count);
      }
      case 5: {
        std::vector<std::uint8_t> out(room);
        return runstone_edits_bytes(edits, choice % 4U, out.data(), out.size(), &count);
      }
      default: {
        runstone_box box{};
        return runstone_edits_bounds(edits, choice % 4U, &box);
      }
    }
  }

  runstone_status mesh(unsigned which) {
    const runstone_chunk* chunk = pick(chunks_);
    const runstone_visibility* table = pick(tables_);
    if (which % 6 == 0) {
      return renew(
          borders_, [&](auto** out) { return runstone_borders_create(chunk, table, out); },
          runstone_borders_free);
    }
    runstone_mesh* to = pick(meshes_);
    if (which % 6 == 1) {
      std::vector<runstone_vertex> out(in_.byte() * 4U);
      std::size_t count = 0;
      const std::uint8_t choice = in_.byte();
      return choice % 2 == 0
                 ? runstone_mesh_vertices(to, choice % 3U, out.data(), out.size(), &count)
                 : runstone_mesh_shape_vertices(to, choice % 3U, out.data(), out.size(), &count);
    }
    if (which % 6 == 4) return occlude(to, chunk, table);
    std::array<const runstone_chunk*, 6> neighbours{};
    std::array<const runstone_borders*, 6> kept{};
    const std::uint8_t given = in_.byte();
    for (std::size_t d = 0; d < 6; ++d) {
      if ((given >> d & 1) != 0) neighbours[d] = pick(chunks_);
      if ((given >> 6 & 1) != 0) kept[d] = pick(borders_);
    }
    if (which % 6 == 2)
      return runstone_mesh_chunk(to, chunk, neighbours.data(), kept.data(), table);
    const runstone_status status =
        runstone_mesh_update(to, chunk, neighbours.data(), kept.data(), table, nullptr);
    if (status == RUNSTONE_OK) check_mesh(to, chunk, neighbours.data(), table);
    return status;
  }

  /// Meshes a chunk in the middle of 26 others and darkens its corners.
  runstone_status occlude(runstone_mesh* to, const runstone_chunk* chunk,
                          const runstone_visibility* table) {
    std::array<const runstone_chunk*, 27> around{};
    for (std::uint8_t given = in_.byte(); given != 0; given /= 2)
      around[in_.byte() % 27] = pick(chunks_);
    const std::array<const runstone_chunk*, 6> beside = {around[12], around[14], around[10],
                                                         around[16], around[4],  around[22]};
    const runstone_status meshed = runstone_mesh_chunk(to, chunk, beside.data(), nullptr, table);
    if (meshed != RUNSTONE_OK) return meshed;
    const std::uint64_t faces = face_count(to);
    const runstone_status status = runstone_mesh_occlude(to, chunk, around.data(), table);
    require(face_count(to) == faces, "occlusion changes the faces of a mesh");
    return status;
  }

  static std::uint64_t face_count(const runstone_mesh* mesh) {
    std::uint64_t out = 0;
    for (const std::uint32_t pass : {0U, 1U}) {
      for (const std::uint64_t quad : quads_of(mesh, pass)) {
        runstone_quad_fields fields{};
        fields.struct_size = sizeof fields;
        require(runstone_quad_unpack(quad, &fields) == RUNSTONE_OK, "a quad is not unpacked");
        out += std::uint64_t{fields.width} * fields.height;
      }
    }
    return out;
  }

  runstone_status collide(unsigned which) {
    std::size_t count = 0;
    runstone_space* space = pick(spaces_);
    const runstone_vec from = in_.vec(), by = in_.vec();
    const runstone_body body{from, {from.x + 1, from.y + 2, from.z + in_.real()}};
    const std::array<std::uint8_t, 4> solid = {0, 1, in_.byte(), in_.byte()};
    switch (which % 7) {
      case 0: {
        const runstone_pos at = {in_.place() / 100, in_.place() / 100, 0};
        return runstone_space_set(space, at, pick(chunks_));
      }
      case 1:
        return runstone_space_set_solid(space, solid.data(), solid[2] % 5U, solid[3] % 2U);
      case 2: {
        runstone_sweep out{};
        out.struct_size = sizeof out;
        return runstone_space_sweep(space, body, by, &out);
      }
      case 3: {
        runstone_slide out{};
        out.struct_size = sizeof out;
        return runstone_space_slide(space, body, by, &out);
      }
      case 4: {
        std::uint32_t is_inside = 0;
        return runstone_space_overlaps(space, body, &is_inside);
      }
      case 5: {
        runstone_ray out{};
        out.struct_size = sizeof out;
        return runstone_space_pick(space, from, by, in_.real(), &out);
      }
      default: {
        std::vector<runstone_local_box> out(in_.byte() * 16U);
        return runstone_chunk_boxes(pick(chunks_), solid.data(), 4, solid[2] % 2U, out.data(),
                                    out.size(), &count);
      }
    }
  }

  static void check_chunk(const runstone_chunk* chunk) {
    std::size_t count = 0;
    require(runstone_chunk_encode(chunk, RUNSTONE_ENCODING_RAW, nullptr, 0, &count) == RUNSTONE_OK,
            "the size of a chunk is not known");
    std::vector<std::uint8_t> bytes(count);
    require(runstone_chunk_encode(chunk, RUNSTONE_ENCODING_RAW, bytes.data(), count, &count) ==
                RUNSTONE_OK,
            "a chunk is not encoded");
    runstone_runs runs;
    require(runstone_runs_open(&runs, bytes.data(), count) == RUNSTONE_RUNS_OK,
            "a chunk is not canonical");
    runstone_chunk* again = nullptr;
    require(runstone_chunk_decode(bytes.data(), count, nullptr, &again) == RUNSTONE_OK,
            "a chunk is not decoded");
    std::array<std::uint64_t, 2> kept{}, computed{};
    runstone_chunk_digest(chunk, kept.data());
    runstone_chunk_digest(again, computed.data());
    require(kept == computed, "the digest of a chunk is not that of its runs");
    runstone_chunk_free(again);
  }

  static std::vector<std::uint64_t> quads_of(const runstone_mesh* mesh, std::uint32_t pass) {
    std::size_t count = 0;
    runstone_mesh_quads(mesh, pass, nullptr, 0, &count);
    std::vector<std::uint64_t> out(count);
    runstone_mesh_quads(mesh, pass, out.data(), count, &count);
    return out;
  }

  static void check_mesh(const runstone_mesh* mesh, const runstone_chunk* chunk,
                         const runstone_chunk* const neighbours[6],
                         const runstone_visibility* table) {
    runstone_mesh* fresh = nullptr;
    require(runstone_mesh_create(&fresh) == RUNSTONE_OK, "a mesh is not made");
    require(runstone_mesh_chunk(fresh, chunk, neighbours, nullptr, table) == RUNSTONE_OK,
            "an updated chunk is not meshed");
    for (const std::uint32_t pass : {0U, 1U})
      require(quads_of(mesh, pass) == quads_of(fresh, pass), "an updated mesh has other quads");
    runstone_mesh_free(fresh);
  }

  ScriptBytes in_;
  Slots<runstone_chunk> chunks_{};
  Slots<runstone_edits> edits_{};
  Slots<runstone_visibility> tables_{};
  Slots<runstone_borders> borders_{};
  Slots<runstone_mesh> meshes_{};
  Slots<runstone_space> spaces_{};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  CallScript({data, size}).run();
  return 0;
}
