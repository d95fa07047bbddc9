// Calls of runstone.h on the events of a client.
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/client_handle.hpp"
#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/runstone.h"
#include "common/core/thread_scratch.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/runs/run_chunk.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace {

std::uint32_t flag_if(bool is_set, std::uint32_t flag) { return is_set ? flag : 0; }

runstone_event event_of_kind(std::uint32_t kind) {
  runstone_event out{};
  out.kind = kind;
  return out;
}
runstone_event event_of_chunk(std::uint32_t kind, const ChunkCoord& at) {
  runstone_event out = event_of_kind(kind);
  out.at = {at.x, at.y, at.z};
  return out;
}
runstone_event event_of_edit(std::uint32_t kind, EditNumber edit) {
  runstone_event out = event_of_kind(kind);
  out.edit = edit;
  return out;
}

// fields_of() allocates nothing, so that no event is lost if memory runs out.

runstone_event fields_of(const WorldOpened& event) {
  runstone_event out = event_of_kind(RUNSTONE_EVENT_WORLD_OPENED);
  out.flags = flag_if(event.is_another, RUNSTONE_FLAG_ANOTHER_WORLD) |
              flag_if(event.is_first_contact, RUNSTONE_FLAG_FIRST_CONTACT);
  return out;
}
runstone_event fields_of(const ConnectionLost& event) {
  runstone_event out = event_of_kind(RUNSTONE_EVENT_CONNECTION_LOST);
  out.flags = flag_if(event.is_final, RUNSTONE_FLAG_FINAL) |
              flag_if(event.lacks_password, RUNSTONE_FLAG_LACKS_PASSWORD);
  return out;
}
runstone_event fields_of(const ChunkChanged& event) {
  runstone_event out = event_of_chunk(RUNSTONE_EVENT_CHUNK_CHANGED, event.source.at);
  out.detail = static_cast<std::uint32_t>(event.cause);
  return out;
}
runstone_event fields_of(const ChunkRemoved& event) {
  return event_of_chunk(RUNSTONE_EVENT_CHUNK_REMOVED, event.at);
}
runstone_event fields_of(const ChunkMissing& event) {
  return event_of_chunk(RUNSTONE_EVENT_CHUNK_MISSING, event.at);
}
runstone_event fields_of(const EditConfirmed& event) {
  runstone_event out = event_of_edit(RUNSTONE_EVENT_EDIT_CONFIRMED, event.edit);
  out.sequence = event.sequence;
  return out;
}
runstone_event fields_of(const EditRejected& event) {
  return event_of_edit(RUNSTONE_EVENT_EDIT_REJECTED, event.edit);
}
runstone_event fields_of(const EditDurable& event) {
  return event_of_edit(RUNSTONE_EVENT_EDIT_DURABLE, event.edit);
}
runstone_event fields_of(const EditUnseen& event) {
  return event_of_edit(RUNSTONE_EVENT_EDIT_UNSEEN, event.edit);
}
runstone_event fields_of(const OthersEdit& event) {
  runstone_event out = event_of_kind(RUNSTONE_EVENT_OTHERS_EDIT);
  out.author = event.author;
  out.sequence = event.sequence;
  return out;
}
runstone_event fields_of(const ChatReceived& event) {
  runstone_event out = event_of_kind(RUNSTONE_EVENT_CHAT);
  out.detail = static_cast<std::uint32_t>(event.from);
  out.utc_us = event.utc_us;
  return out;
}
runstone_event fields_of(const CommandDone& event) {
  runstone_event out = event_of_kind(RUNSTONE_EVENT_COMMAND_DONE);
  out.flags = flag_if(event.is_ok, RUNSTONE_FLAG_OK) |
              flag_if(event.is_answer_lost, RUNSTONE_FLAG_ANSWER_LOST);
  return out;
}
runstone_event fields_of(const MaterialsChanged&) {
  return event_of_kind(RUNSTONE_EVENT_MATERIALS_CHANGED);
}
runstone_event fields_of(const PlayersChanged&) {
  return event_of_kind(RUNSTONE_EVENT_PLAYERS_CHANGED);
}
runstone_event fields_of(const ClientWarning&) { return event_of_kind(RUNSTONE_EVENT_WARNING); }

struct EventTexts {
  std::string text, more;
};

EventTexts texts_of(const ConnectionLost& event) { return {event.headline, event.detail}; }
EventTexts texts_of(const EditRejected& event) { return {event.text, event.reason}; }
EventTexts texts_of(const ChatReceived& event) { return {event.text, event.name}; }
EventTexts texts_of(const CommandDone& event) {
  EventTexts out;
  for (const std::string& line : event.lines) {
    if (!out.text.empty()) out.text += '\n';
    out.text += line;
  }
  return out;
}
EventTexts texts_of(const ClientWarning& event) { return {event.text, {}}; }
template <class Event>
EventTexts texts_of(const Event&) {
  static_assert(!requires(const Event& event) { event.text; });
  return {};
}

const WorldEvent& event_at(runstone_client* client, std::size_t index) {
  const std::span<const WorldEvent> drained = live(client, "client").drained();
  if (index >= drained.size())
    refuse(RUNSTONE_NOT_FOUND, "index", "is not that of an event of the last call that drained");
  return drained[index];
}

EventTexts texts_at(runstone_client* client, std::size_t index) {
  return std::visit([](const auto& of) { return texts_of(of); }, event_at(client, index));
}

const MeshSource& source_at(runstone_client* client, std::size_t index) {
  const auto* const changed = std::get_if<ChunkChanged>(&event_at(client, index));
  if (changed == nullptr)
    refuse(RUNSTONE_NOT_FOUND, "index", "is that of an event of another kind");
  return changed->source;
}

void write_event_text(const std::string& text, char* out, std::size_t capacity,
                      std::size_t* count) {
  write_elements(std::span<const char>(text.c_str(), text.size() + 1), out, capacity, count);
}

}  // namespace

runstone_status runstone_client_drain(runstone_client* client, size_t chunks_max,
                                      runstone_event* out, size_t event_size, size_t capacity,
                                      size_t* count) {
  return answer([&] {
    runstone_client& of = live(client, "client");
    given(out, "out");
    given(count, "count") = 0;
    if (capacity == 0) refuse(RUNSTONE_BAD_ARGUMENT, "capacity", "is 0");
    if (event_size < sizeof(runstone_event) || event_size % alignof(runstone_event) != 0)
      refuse(RUNSTONE_BAD_ARGUMENT, "event_size", "is not the size of the struct");
    const std::span<const WorldEvent> drained = of.drain(chunks_max, capacity);
    auto* bytes = reinterpret_cast<std::uint8_t*>(out);
    for (const WorldEvent& event : drained) {
      runstone_event fields = std::visit([](const auto& each) { return fields_of(each); }, event);
      fields.struct_size = static_cast<std::uint32_t>(event_size);
      std::memcpy(bytes, &fields, sizeof fields);
      bytes += event_size;
    }
    *count = drained.size();
  });
}

runstone_status runstone_client_event_text(runstone_client* client, size_t index, char* out,
                                           size_t capacity, size_t* count) {
  return answer([&] { write_event_text(texts_at(client, index).text, out, capacity, count); });
}

runstone_status runstone_client_event_more(runstone_client* client, size_t index, char* out,
                                           size_t capacity, size_t* count) {
  return answer([&] { write_event_text(texts_at(client, index).more, out, capacity, count); });
}

runstone_status runstone_client_event_chunks(runstone_client* client, size_t index,
                                             runstone_pos* out, size_t capacity, size_t* count) {
  return answer([&] {
    const auto* const edit = std::get_if<OthersEdit>(&event_at(client, index));
    if (edit == nullptr) refuse(RUNSTONE_NOT_FOUND, "index", "is that of an event of another kind");
    if (!has_room(out, capacity, edit->chunks.size(), count)) return;
    for (const ChunkCoord& at : edit->chunks) *out++ = {at.x, at.y, at.z};
  });
}

runstone_status runstone_client_take_chunk(runstone_client* client, size_t index,
                                           runstone_chunk** chunk, runstone_chunk* neighbours[6]) {
  return answer([&] {
    output(chunk, "chunk");
    if (neighbours != nullptr) std::fill_n(neighbours, kDirectionCount, nullptr);
    const MeshSource& source = source_at(client, index);
    // The caller gets no handle before all of them are made.
    std::array<std::unique_ptr<runstone_chunk>, kDirectionCount> beside;
    for (std::size_t d = 0; d < beside.size(); ++d) {
      if (neighbours != nullptr && source.neighbours[d] != nullptr)
        beside[d] = std::make_unique<runstone_chunk>(*source.neighbours[d]);
    }
    create(chunk, *source.chunk);
    for (std::size_t d = 0; d < beside.size(); ++d) {
      if (neighbours != nullptr) neighbours[d] = beside[d].release();
    }
  });
}

runstone_status runstone_client_mesh(runstone_client* client, size_t index, runstone_mesh* mesh) {
  return answer([&] {
    const MeshSource& source = source_at(client, index);
    runstone_mesh& made = live(mesh, "mesh");
    const auto materials = client->client.mesh_materials();
    // The chunks have no handles, so the next runstone_mesh_update() makes a new mesh.
    made.change_quads([&] {
      with_scratch<ChunkMeshScratch>([&](ChunkMeshScratch& scratch) {
        mesh_chunk(*source.chunk, source.beside(), {}, *materials, scratch, made.quads);
      });
    });
    made.materials = materials;
  });
}
