// Every function of runstone.h with NULL and with a handle of another kind. The list of functions is
// compared with symbols.txt, so that no function is left out.
#include <catch2/catch.hpp>
#include <fstream>
#include <functional>
#include <set>
#include <string>

#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

/// A call with a handle of any kind or NULL; every other pointer is NULL, too.
struct HandleCall {
  const char* name;
  std::function<runstone_status(void*)> call;
};

template <class T>
T* as(void* handle) {
  return static_cast<T*>(handle);
}

const std::vector<HandleCall>& handle_calls() {
  static const runstone_pos kPos{0, 0, 0};
  static const runstone_body kBody{{0, 0, 0}, {1, 1, 1}};
  static const std::vector<HandleCall> kCalls = {
      {"runstone_chunk_clone",
       [](void* h) { return runstone_chunk_clone(as<runstone_chunk>(h), nullptr); }},
      {"runstone_chunk_get_info",
       [](void* h) { return runstone_chunk_get_info(as<runstone_chunk>(h), nullptr); }},
      {"runstone_chunk_get",
       [](void* h) { return runstone_chunk_get(as<runstone_chunk>(h), 0, 0, 0, nullptr); }},
      {"runstone_chunk_fill",
       [](void* h) { return runstone_chunk_fill(as<runstone_chunk>(h), 0, 1, 0); }},
      {"runstone_chunk_to_array",
       [](void* h) {
         return runstone_chunk_to_array(as<runstone_chunk>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_chunk_runs",
       [](void* h) {
         return runstone_chunk_runs(as<runstone_chunk>(h), nullptr, nullptr, 0, nullptr);
       }},
      {"runstone_chunk_reorder",
       [](void* h) { return runstone_chunk_reorder(as<runstone_chunk>(h), 0); }},
      {"runstone_chunk_digest",
       [](void* h) { return runstone_chunk_digest(as<runstone_chunk>(h), nullptr); }},
      {"runstone_chunk_equal",
       [](void* h) {
         return runstone_chunk_equal(as<runstone_chunk>(h), as<runstone_chunk>(h), nullptr);
       }},
      {"runstone_chunk_encode",
       [](void* h) {
         return runstone_chunk_encode(as<runstone_chunk>(h), 1, nullptr, 0, nullptr);
       }},
      {"runstone_chunk_apply",
       [](void* h) { return runstone_chunk_apply(as<runstone_chunk>(h), kPos, nullptr, nullptr); }},
      {"runstone_chunk_boxes",
       [](void* h) {
         return runstone_chunk_boxes(as<runstone_chunk>(h), nullptr, 0, 1, nullptr, 0, nullptr);
       }},
      {"runstone_edits_clear", [](void* h) { return runstone_edits_clear(as<runstone_edits>(h)); }},
      {"runstone_edits_count",
       [](void* h) { return runstone_edits_count(as<runstone_edits>(h), nullptr); }},
      {"runstone_edits_add_voxel",
       [](void* h) { return runstone_edits_add_voxel(as<runstone_edits>(h), kPos, nullptr); }},
      {"runstone_edits_add_box",
       [](void* h) {
         return runstone_edits_add_box(as<runstone_edits>(h), {kPos, {1, 1, 1}}, nullptr);
       }},
      {"runstone_edits_add_sphere",
       [](void* h) { return runstone_edits_add_sphere(as<runstone_edits>(h), kPos, 1, nullptr); }},
      {"runstone_edits_add_stroke",
       [](void* h) {
         return runstone_edits_add_stroke(as<runstone_edits>(h), nullptr, 2, 1, nullptr);
       }},
      {"runstone_edits_add_bytes",
       [](void* h) { return runstone_edits_add_bytes(as<runstone_edits>(h), nullptr, 1); }},
      {"runstone_edits_bytes",
       [](void* h) { return runstone_edits_bytes(as<runstone_edits>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_edits_bounds",
       [](void* h) { return runstone_edits_bounds(as<runstone_edits>(h), 0, nullptr); }},
      {"runstone_edits_touched_chunks",
       [](void* h) {
         return runstone_edits_touched_chunks(as<runstone_edits>(h), 0, 16, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_chunk",
       [](void* h) {
         return runstone_mesh_chunk(as<runstone_mesh>(h), nullptr, nullptr, nullptr, nullptr);
       }},
      {"runstone_mesh_update",
       [](void* h) {
         return runstone_mesh_update(as<runstone_mesh>(h), nullptr, nullptr, nullptr, nullptr,
                                     nullptr);
       }},
      {"runstone_mesh_quads",
       [](void* h) { return runstone_mesh_quads(as<runstone_mesh>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_mesh_layer_quads",
       [](void* h) {
         return runstone_mesh_layer_quads(as<runstone_mesh>(h), 0, 0, 0, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_vertices",
       [](void* h) {
         return runstone_mesh_vertices(as<runstone_mesh>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_indices",
       [](void* h) { return runstone_mesh_indices(as<runstone_mesh>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_borders_create",
       [](void* h) {
         runstone_borders* out = nullptr;
         return runstone_borders_create(as<runstone_chunk>(h), nullptr, &out);
       }},
      {"runstone_visibility_create_with_shapes",
       [](void* h) {
         runstone_visibility* out = nullptr;
         return runstone_visibility_create_with_shapes(nullptr, 0, as<runstone_shapes>(h), &out);
       }},
      {"runstone_shapes_add",
       [](void* h) { return runstone_shapes_add(as<runstone_shapes>(h), 1, 0, nullptr, 1); }},
      {"runstone_shapes_add_kind",
       [](void* h) {
         return runstone_shapes_add_kind(as<runstone_shapes>(h), 1, nullptr, nullptr);
       }},
      {"runstone_mesh_occlude",
       [](void* h) {
         return runstone_mesh_occlude(as<runstone_mesh>(h), nullptr, nullptr, nullptr);
       }},
      {"runstone_mesh_occlusion",
       [](void* h) {
         return runstone_mesh_occlusion(as<runstone_mesh>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_shape_quads",
       [](void* h) {
         return runstone_mesh_shape_quads(as<runstone_mesh>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_shape_vertices",
       [](void* h) {
         return runstone_mesh_shape_vertices(as<runstone_mesh>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_mesh_shape_indices",
       [](void* h) {
         return runstone_mesh_shape_indices(as<runstone_mesh>(h), 0, nullptr, 0, nullptr);
       }},
      {"runstone_tile_veil",
       [](void* h) { return runstone_tile_veil(as<runstone_chunk>(h), nullptr); }},
      {"runstone_space_set",
       [](void* h) { return runstone_space_set(as<runstone_space>(h), kPos, nullptr); }},
      {"runstone_space_set_solid",
       [](void* h) { return runstone_space_set_solid(as<runstone_space>(h), nullptr, 1, 1); }},
      {"runstone_space_sweep",
       [](void* h) {
         return runstone_space_sweep(as<runstone_space>(h), kBody, {0, 0, 0}, nullptr);
       }},
      {"runstone_space_slide",
       [](void* h) {
         return runstone_space_slide(as<runstone_space>(h), kBody, {0, 0, 0}, nullptr);
       }},
      {"runstone_space_overlaps",
       [](void* h) { return runstone_space_overlaps(as<runstone_space>(h), kBody, nullptr); }},
      {"runstone_space_pick",
       [](void* h) {
         return runstone_space_pick(as<runstone_space>(h), {0, 0, 0}, {0, 0, 1}, 1, nullptr);
       }},
  };
  return kCalls;
}

const std::vector<HandleCall>& client_calls() {
  using Client = runstone_client;
  static const std::vector<HandleCall> kCalls = {
      {"runstone_client_close", [](void* h) { return runstone_client_close(as<Client>(h)); }},
      {"runstone_client_step",
       [](void* h) { return runstone_client_step(as<Client>(h), nullptr); }},
      {"runstone_client_wait", [](void* h) { return runstone_client_wait(as<Client>(h), 0); }},
      {"runstone_client_drain",
       [](void* h) {
         return runstone_client_drain(as<Client>(h), 1, nullptr, sizeof(runstone_event), 1,
                                      nullptr);
       }},
      {"runstone_client_event_text",
       [](void* h) { return runstone_client_event_text(as<Client>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_client_event_more",
       [](void* h) { return runstone_client_event_more(as<Client>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_client_event_chunks",
       [](void* h) { return runstone_client_event_chunks(as<Client>(h), 0, nullptr, 0, nullptr); }},
      {"runstone_client_take_chunk",
       [](void* h) {
         runstone_chunk* out = nullptr;
         return runstone_client_take_chunk(as<Client>(h), 0, &out, nullptr);
       }},
      {"runstone_client_mesh",
       [](void* h) { return runstone_client_mesh(as<Client>(h), 0, nullptr); }},
      {"runstone_client_outdated",
       [](void* h) { return runstone_client_outdated(as<Client>(h), nullptr); }},
      {"runstone_client_state",
       [](void* h) { return runstone_client_state(as<Client>(h), nullptr, nullptr); }},
      {"runstone_client_world",
       [](void* h) { return runstone_client_world(as<Client>(h), nullptr); }},
      {"runstone_client_move",
       [](void* h) { return runstone_client_move(as<Client>(h), nullptr); }},
      {"runstone_client_place",
       [](void* h) { return runstone_client_place(as<Client>(h), nullptr); }},
      {"runstone_client_set_view",
       [](void* h) { return runstone_client_set_view(as<Client>(h), 1, 1); }},
      {"runstone_client_submit",
       [](void* h) { return runstone_client_submit(as<Client>(h), nullptr, 0, 0, nullptr); }},
      {"runstone_client_submit_delay",
       [](void* h) { return runstone_client_submit_delay(as<Client>(h), nullptr, 0, nullptr); }},
      {"runstone_client_chat",
       [](void* h) { return runstone_client_chat(as<Client>(h), nullptr); }},
      {"runstone_client_command",
       [](void* h) { return runstone_client_command(as<Client>(h), nullptr); }},
      {"runstone_client_chunk",
       [](void* h) {
         runstone_chunk* out = nullptr;
         return runstone_client_chunk(as<Client>(h), {0, 0, 0}, &out);
       }},
      {"runstone_client_chunks",
       [](void* h) { return runstone_client_chunks(as<Client>(h), nullptr, 0, nullptr); }},
      {"runstone_client_material_at",
       [](void* h) { return runstone_client_material_at(as<Client>(h), {0, 0, 0}, nullptr); }},
      {"runstone_client_material_count",
       [](void* h) { return runstone_client_material_count(as<Client>(h), nullptr); }},
      {"runstone_client_material",
       [](void* h) { return runstone_client_material(as<Client>(h), 0, nullptr); }},
      {"runstone_client_find_material",
       [](void* h) { return runstone_client_find_material(as<Client>(h), nullptr, nullptr); }},
      {"runstone_client_visibility",
       [](void* h) {
         runstone_visibility* out = nullptr;
         return runstone_client_visibility(as<Client>(h), &out);
       }},
      {"runstone_client_players",
       [](void* h) { return runstone_client_players(as<Client>(h), nullptr, 0, nullptr); }},
  };
  return kCalls;
}

const std::vector<HandleCall>& free_calls() {
  static const std::vector<HandleCall> kCalls = {
      {"runstone_chunk_free", [](void* h) { return runstone_chunk_free(as<runstone_chunk>(h)); }},
      {"runstone_edits_free", [](void* h) { return runstone_edits_free(as<runstone_edits>(h)); }},
      {"runstone_visibility_free",
       [](void* h) { return runstone_visibility_free(as<runstone_visibility>(h)); }},
      {"runstone_borders_free",
       [](void* h) { return runstone_borders_free(as<runstone_borders>(h)); }},
      {"runstone_shapes_free",
       [](void* h) { return runstone_shapes_free(as<runstone_shapes>(h)); }},
      {"runstone_client_free",
       [](void* h) { return runstone_client_free(as<runstone_client>(h)); }},
      {"runstone_mesh_free", [](void* h) { return runstone_mesh_free(as<runstone_mesh>(h)); }},
      {"runstone_space_free", [](void* h) { return runstone_space_free(as<runstone_space>(h)); }},
  };
  return kCalls;
}

/// Calls that begin with something else than a handle, with NULL for every pointer.
struct PlainCall {
  const char* name;
  runstone_status status;
};

std::vector<PlainCall> plain_calls() {
  return {
      {"runstone_chunk_create_filled", runstone_chunk_create_filled(8, 8, 8, 1, nullptr)},
      {"runstone_chunk_create_from_array",
       runstone_chunk_create_from_array(8, 8, 8, 0, nullptr, 512, nullptr)},
      {"runstone_chunk_create_from_runs",
       runstone_chunk_create_from_runs(8, 8, 8, 0, nullptr, nullptr, 1, nullptr)},
      {"runstone_chunk_decode", runstone_chunk_decode(nullptr, 1, nullptr, nullptr)},
      {"runstone_edits_create", runstone_edits_create(nullptr)},
      {"runstone_visibility_create", runstone_visibility_create(nullptr, 1, nullptr)},
      {"runstone_mesh_create", runstone_mesh_create(nullptr)},
      {"runstone_shapes_create", runstone_shapes_create(nullptr)},
      {"runstone_client_default_options", runstone_client_default_options(nullptr)},
      {"runstone_client_connect", runstone_client_connect(nullptr, nullptr)},
      {"runstone_quad_unpack", runstone_quad_unpack(0, nullptr)},
      {"runstone_tile_build", runstone_tile_build(nullptr, 16, 0, nullptr, nullptr)},
      {"runstone_space_create", runstone_space_create(16, nullptr)},
  };
}

}  // namespace

TEST_CASE("every function of the C interface refuses NULL", "[c_interface]") {
  for (const auto* calls : {&handle_calls(), &client_calls()}) {
    for (const HandleCall& call : *calls) {
      CAPTURE(call.name);
      CHECK(call.call(nullptr) == RUNSTONE_BAD_ARGUMENT);
      CHECK(std::string(runstone_last_error()).find("is NULL") != std::string::npos);
    }
  }
  for (const PlainCall& call : plain_calls()) {
    CAPTURE(call.name);
    CHECK(call.status == RUNSTONE_BAD_ARGUMENT);
  }
  for (const HandleCall& call : free_calls()) {
    CAPTURE(call.name);
    CHECK(call.call(nullptr) == RUNSTONE_OK);
  }
}

TEST_CASE("every function of the C interface refuses a handle of another kind", "[c_interface]") {
  const auto edits = owned<runstone_edits>(runstone_edits_create);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  for (const auto* calls : {&handle_calls(), &client_calls(), &free_calls()}) {
    for (const HandleCall& call : *calls) {
      CAPTURE(call.name);
      // An edit list is foreign to all functions but its own, and a mesh is foreign to those.
      const bool takes_edits = std::string(call.name).starts_with("runstone_edits_");
      void* const foreign = takes_edits ? static_cast<void*>(mesh.get()) : edits.get();
      const runstone_status status = call.call(foreign);
      // Outputs are checked first where they are handles.
      CHECK((status == RUNSTONE_BAD_HANDLE || (std::string(call.name) == "runstone_chunk_clone" &&
                                               status == RUNSTONE_BAD_ARGUMENT)));
    }
  }
  runstone_chunk* out = nullptr;
  CHECK(runstone_chunk_clone(reinterpret_cast<runstone_chunk*>(edits.get()), &out) ==
        RUNSTONE_BAD_HANDLE);
  CHECK(out == nullptr);
}

TEST_CASE("no function of the C interface is left out of these tests", "[c_interface]") {
  std::set<std::string> tested = {"runstone_abi", "runstone_version", "runstone_last_error",
                                  "runstone_status_name"};
  for (const HandleCall& call : handle_calls()) tested.insert(call.name);
  for (const HandleCall& call : client_calls()) tested.insert(call.name);
  for (const HandleCall& call : free_calls()) tested.insert(call.name);
  for (const PlainCall& call : plain_calls()) tested.insert(call.name);
  std::set<std::string> exported;
  std::ifstream in(RUNSTONE_SOURCE_DIR "/bindings/c/symbols.txt");
  for (std::string line; std::getline(in, line);) exported.insert(line);
  CHECK(exported.size() > 40);
  CHECK(tested == exported);
}

TEST_CASE("the C interface names its version and statuses", "[c_interface]") {
  CHECK(runstone_abi() == RUNSTONE_ABI);
  CHECK(std::string(runstone_version()).find('.') != std::string::npos);
  std::set<std::string> names;
  for (runstone_status status = RUNSTONE_OK; status <= RUNSTONE_UNSUPPORTED; ++status)
    names.insert(runstone_status_name(status));
  CHECK(names.size() == RUNSTONE_UNSUPPORTED + 1);
  CHECK(std::string(runstone_status_name(-1)) == "unknown status");
  CHECK(std::string(runstone_status_name(RUNSTONE_UNSUPPORTED + 1)) == "unknown status");
}

}  // namespace runstone::test
