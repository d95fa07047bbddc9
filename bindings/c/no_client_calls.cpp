// The calls of runstone.h on a client, for builds without one. No handle of a client exists there,
// so every call that takes one refuses it.
#include "bindings/c/handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"

using namespace runstone::c_interface;

struct runstone_client : Handle<0x746e6c63> {};

namespace {

runstone_status no_client(const runstone_client* client) {
  return answer([&] { live(client, "client"); });
}

}  // namespace

runstone_status runstone_client_default_options(runstone_client_options* out) {
  return answer([&] { fill_versioned(versioned(out, "out"), {}); });
}

runstone_status runstone_client_connect(const runstone_client_options*, runstone_client** out) {
  return answer([&] {
    output(out, "out");
    refuse(RUNSTONE_UNSUPPORTED, "runstone_client_connect()",
           "is not in this build of the library");
  });
}

runstone_status runstone_client_free(runstone_client* client) {
  return free_handle(client, "client");
}

runstone_status runstone_client_close(runstone_client* client) { return no_client(client); }

runstone_status runstone_client_step(runstone_client* client, uint32_t*) {
  return no_client(client);
}

runstone_status runstone_client_wait(runstone_client* client, uint32_t) {
  return no_client(client);
}

runstone_status runstone_client_drain(runstone_client* client, size_t, runstone_event*, size_t,
                                      size_t, size_t*) {
  return no_client(client);
}

runstone_status runstone_client_event_text(runstone_client* client, size_t, char*, size_t,
                                           size_t*) {
  return no_client(client);
}

runstone_status runstone_client_event_more(runstone_client* client, size_t, char*, size_t,
                                           size_t*) {
  return no_client(client);
}

runstone_status runstone_client_event_chunks(runstone_client* client, size_t, runstone_pos*, size_t,
                                             size_t*) {
  return no_client(client);
}

runstone_status runstone_client_take_chunk(runstone_client* client, size_t, runstone_chunk**,
                                           runstone_chunk* [6]) {
  return no_client(client);
}

runstone_status runstone_client_mesh(runstone_client* client, size_t, runstone_mesh*) {
  return no_client(client);
}

runstone_status runstone_client_outdated(runstone_client* client, size_t*) {
  return no_client(client);
}

runstone_status runstone_client_state(runstone_client* client, uint32_t*, uint32_t*) {
  return no_client(client);
}

runstone_status runstone_client_world(runstone_client* client, runstone_world_info*) {
  return no_client(client);
}

runstone_status runstone_client_move(runstone_client* client, const runstone_place*) {
  return no_client(client);
}

runstone_status runstone_client_place(runstone_client* client, runstone_place*) {
  return no_client(client);
}

runstone_status runstone_client_set_view(runstone_client* client, uint32_t, uint32_t) {
  return no_client(client);
}

runstone_status runstone_client_submit(runstone_client* client, const runstone_edits*, size_t,
                                       uint64_t, uint64_t*) {
  return no_client(client);
}

runstone_status runstone_client_submit_delay(runstone_client* client, const runstone_edits*, size_t,
                                             int64_t*) {
  return no_client(client);
}

runstone_status runstone_client_chat(runstone_client* client, const char*) {
  return no_client(client);
}

runstone_status runstone_client_command(runstone_client* client, const char*) {
  return no_client(client);
}

runstone_status runstone_client_chunk(runstone_client* client, runstone_pos, runstone_chunk**) {
  return no_client(client);
}

runstone_status runstone_client_chunks(runstone_client* client, runstone_pos*, size_t, size_t*) {
  return no_client(client);
}

runstone_status runstone_client_material_at(runstone_client* client, runstone_pos, uint16_t*) {
  return no_client(client);
}

runstone_status runstone_client_material_count(runstone_client* client, size_t*) {
  return no_client(client);
}

runstone_status runstone_client_material(runstone_client* client, uint32_t,
                                         runstone_material_info*) {
  return no_client(client);
}

runstone_status runstone_client_find_material(runstone_client* client, const char*, uint16_t*) {
  return no_client(client);
}

runstone_status runstone_client_visibility(runstone_client* client, runstone_visibility**) {
  return no_client(client);
}

runstone_status runstone_client_players(runstone_client* client, runstone_player*, size_t,
                                        size_t*) {
  return no_client(client);
}
