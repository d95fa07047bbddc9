#include "client/display/upload_tracker.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {
constexpr ChunkKey kA{0, {1, 0, 0}}, kB{0, {2, 0, 0}};
}

TEST_CASE("a mesh is on the screen after the frame that follows its upload", "[client_app]") {
  UploadTracker tracker;
  CHECK(tracker.empty());
  tracker.queued(kA, 1, Urgency::edit);
  tracker.presented();  // a frame to which the mesh was carried over
  CHECK(tracker.has_edits());
  tracker.uploaded(kA, 1);
  CHECK_FALSE(tracker.empty());
  CHECK(tracker.has_edits());
  tracker.presented();
  CHECK(tracker.empty());
  CHECK_FALSE(tracker.has_edits());
}

TEST_CASE("the upload of an older mesh shows its edit and not the newer one", "[client_app]") {
  UploadTracker tracker;
  tracker.queued(kA, 1, Urgency::local_edit);
  tracker.queued(kA, 2, Urgency::terrain);
  tracker.queued(kA, 3, Urgency::edit);  // mesh 1 is being uploaded, so it is not replaced
  tracker.uploaded(kA, 1);
  CHECK(tracker.has_edits_up_to(1));
  tracker.presented();
  CHECK_FALSE(tracker.empty());
  CHECK(tracker.has_edits());
  CHECK_FALSE(tracker.has_edits_up_to(2));
  tracker.uploaded(kA, 3);
  tracker.presented();
  CHECK(tracker.empty());
  CHECK_FALSE(tracker.has_edits());
}

TEST_CASE("terrain is no edit, and a chunk that left is not waited for", "[client_app]") {
  UploadTracker tracker;
  tracker.queued(kA, 1, Urgency::terrain);
  CHECK_FALSE(tracker.has_edits());
  tracker.queued(kB, 2, Urgency::edit);
  CHECK(tracker.has_edits());
  tracker.removed(kB);
  CHECK_FALSE(tracker.has_edits());
  CHECK_FALSE(tracker.empty());
  tracker.removed(kA);
  tracker.removed(kA);
  CHECK(tracker.empty());
}

TEST_CASE("edits are waited for up to a number, whatever replaces their meshes", "[client_app]") {
  UploadTracker tracker;
  tracker.queued(kA, 3, Urgency::edit);
  tracker.queued(kA, 9, Urgency::edit);  // replaces mesh 3, so it shows its edit
  tracker.queued(kB, 5, Urgency::edit);
  CHECK_FALSE(tracker.has_edits_up_to(2));
  CHECK(tracker.has_edits_up_to(3));
  tracker.uploaded(kB, 5);
  tracker.uploaded(kA, 9);
  CHECK(tracker.has_edits_up_to(3));  // uploaded, in no frame
  tracker.queued(kA, 10, Urgency::edit);
  tracker.presented();
  CHECK_FALSE(tracker.has_edits_up_to(9));
  CHECK(tracker.has_edits_up_to(10));
}
