#include "client/display/upload_queue.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

ChunkKey row_chunk(std::int32_t x) { return {0, {x, 0, 0}}; }

ChunkUpload upload_of(Urgency urgency, std::uint64_t number = 1) {
  ChunkUpload upload;
  upload.number = number;
  upload.edge = 16;
  upload.urgency = urgency;
  upload.mesh = std::make_shared<const ChunkMesh>();
  return upload;
}

/// Takes all uploads. Returns the x of their chunks.
std::vector<std::int32_t> order_of(UploadQueue& queue) {
  std::vector<std::int32_t> out;
  while (const auto next = queue.take_upload()) out.push_back(next->first.at.x);
  return out;
}

using Order = std::vector<std::int32_t>;

}  // namespace

TEST_CASE(
    "edits of this client come first, then those of others, then terrain, each from near to far",
    "[client_app]") {
  UploadQueue queue;
  queue.put(row_chunk(1), upload_of(Urgency::terrain));
  queue.put(row_chunk(-2), upload_of(Urgency::terrain));
  queue.put(row_chunk(6), upload_of(Urgency::edit));
  queue.put(row_chunk(4), upload_of(Urgency::edit));
  queue.put(row_chunk(9), upload_of(Urgency::local_edit));
  SECTION("around the origin") { CHECK(order_of(queue) == Order{9, 4, 6, 1, -2}); }
  SECTION("after the eye moved") {
    queue.set_eye({7, 0, 0});
    CHECK(order_of(queue) == Order{9, 6, 4, 1, -2});
  }
  CHECK(queue.empty());
}

TEST_CASE("a newer change replaces an older one of its chunk and keeps the higher rank",
          "[client_app]") {
  UploadQueue queue;
  queue.put(row_chunk(5), upload_of(Urgency::local_edit, 1));
  queue.put(row_chunk(5), upload_of(Urgency::terrain, 2));
  queue.put(row_chunk(1), upload_of(Urgency::edit, 3));
  CHECK(queue.size() == 2);
  const auto first = queue.take_upload();
  REQUIRE(first);
  CHECK(first->first == row_chunk(5));
  CHECK(first->second.number == 2);
  queue.put(row_chunk(5), upload_of(Urgency::terrain, 4));
  CHECK(order_of(queue) == Order{1, 5});  // the rank left with the upload
}

TEST_CASE("removals replace uploads and uploads replace removals", "[client_app]") {
  UploadQueue queue;
  queue.put(row_chunk(1), upload_of(Urgency::edit));
  queue.remove(row_chunk(1));
  queue.remove(row_chunk(2));
  queue.put(row_chunk(2), upload_of(Urgency::edit));
  CHECK(queue.size() == 2);
  CHECK(queue.take_removals() == std::vector<ChunkKey>{row_chunk(1)});
  CHECK(order_of(queue) == Order{2});
  CHECK(queue.take_removals().empty());
}

TEST_CASE("an upload that has waited long comes before edits of others", "[client_app]") {
  UploadQueue queue;
  queue.put(row_chunk(8), upload_of(Urgency::terrain));
  queue.put(row_chunk(9), upload_of(Urgency::local_edit));
  for (std::uint64_t frame = 1; frame < UploadQueue::kPatience; ++frame) queue.frame_passed();
  queue.put(row_chunk(1), upload_of(Urgency::edit));
  SECTION("not yet") { CHECK(order_of(queue) == Order{9, 1, 8}); }
  SECTION("now") {
    queue.frame_passed();
    CHECK(order_of(queue) == Order{9, 8, 1});
  }
  SECTION("replaced meanwhile") {
    queue.put(row_chunk(8), upload_of(Urgency::terrain, 7));
    queue.frame_passed();
    CHECK(order_of(queue) == Order{9, 8, 1});
  }
  SECTION("removed and back") {
    queue.remove(row_chunk(8));
    queue.put(row_chunk(8), upload_of(Urgency::terrain));
    queue.frame_passed();
    CHECK(order_of(queue) == Order{9, 1, 8});
  }
}

TEST_CASE("under a stream of near edits every chunk is uploaded in the end", "[client_app]") {
  UploadQueue queue;
  queue.put(row_chunk(100), upload_of(Urgency::terrain));
  bool is_uploaded = false;
  for (std::uint64_t frame = 0; frame <= UploadQueue::kPatience + 4 && !is_uploaded; ++frame) {
    for (const std::int32_t x : {1, 2, 3}) queue.put(row_chunk(x), upload_of(Urgency::edit));
    queue.frame_passed();
    is_uploaded = queue.take_upload()->first == row_chunk(100);
  }
  CHECK(is_uploaded);
}

TEST_CASE("the bytes of an upload are its quads and the runs of mixed chunks", "[client_app]") {
  ChunkMesh mesh;
  mesh.opaque.quads.resize(3);
  mesh.transparent.quads.resize(2);
  CHECK(gpu_bytes(mesh, nullptr) == 5 * sizeof(Quad));
  const RunChunk uniform = uniform_chunk(Extent::cube(16), 1);
  CHECK(gpu_bytes(mesh, &uniform) == 5 * sizeof(Quad));
  RunChunk mixed = uniform;
  fill(mixed, 7, 3, 2);
  CHECK(gpu_bytes(mesh, &mixed) == 5 * sizeof(Quad) + mixed.runs.byte_size() + 256);
}

TEST_CASE("tiles come after chunks, finer levels first, then from near to far", "[client_app]") {
  UploadQueue queue;
  const auto tile = [&queue](std::uint8_t lod, std::int32_t x) {
    ChunkUpload upload;
    upload.tile = std::make_shared<const TileMesh>();
    queue.put({lod, {x, 0, 0}}, std::move(upload));
  };
  tile(2, 1);
  tile(1, -7);
  tile(1, 6);
  queue.put(row_chunk(99), upload_of(Urgency::terrain));
  CHECK(order_of(queue) == Order{99, 6, -7, 1});
}
