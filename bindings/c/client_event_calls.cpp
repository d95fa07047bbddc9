// Calls of runstone.h on the events of a client.
#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
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

/// An event as a program in C sees it.
struct EventView {
  runstone_event fields{};
  std::string text, more;
};

std::uint32_t flag_if(bool is_set, std::uint32_t flag) { return is_set ? flag : 0; }

void set_place(EventView& out, const ChunkCoord& at) { out.fields.at = {at.x, at.y, at.z}; }

void view(const WorldOpened& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_WORLD_OPENED;
  out.fields.flags = flag_if(event.is_another, RUNSTONE_FLAG_ANOTHER_WORLD) |
                     flag_if(event.is_first_contact, RUNSTONE_FLAG_FIRST_CONTACT);
}
void view(const ConnectionLost& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_CONNECTION_LOST;
  out.fields.flags = flag_if(event.is_final, RUNSTONE_FLAG_FINAL) |
                     flag_if(event.lacks_password, RUNSTONE_FLAG_LACKS_PASSWORD);
  out.text = event.headline;
  out.more = event.detail;
}
void view(const ChunkChanged& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_CHUNK_CHANGED;
  out.fields.detail = static_cast<std::uint32_t>(event.cause);
  set_place(out, event.source.at);
}
void view(const ChunkRemoved& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_CHUNK_REMOVED;
  set_place(out, event.at);
}
void view(const ChunkMissing& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_CHUNK_MISSING;
  set_place(out, event.at);
}
void view(const EditConfirmed& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_EDIT_CONFIRMED;
  out.fields.edit = event.edit;
  out.fields.sequence = event.sequence;
}
void view(const EditRejected& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_EDIT_REJECTED;
  out.fields.edit = event.edit;
  out.text = event.text;
  out.more = event.reason;
}
void view(const EditDurable& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_EDIT_DURABLE;
  out.fields.edit = event.edit;
}
void view(const EditUnseen& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_EDIT_UNSEEN;
  out.fields.edit = event.edit;
}
void view(const OthersEdit& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_OTHERS_EDIT;
  out.fields.author = event.author;
  out.fields.sequence = event.sequence;
}
void view(const ChatReceived& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_CHAT;
  out.fields.detail = static_cast<std::uint32_t>(event.from);
  out.fields.utc_us = event.utc_us;
  out.text = event.text;
  out.more = event.name;
}
void view(const CommandDone& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_COMMAND_DONE;
  out.fields.flags = flag_if(event.is_ok, RUNSTONE_FLAG_OK) |
                     flag_if(event.is_answer_lost, RUNSTONE_FLAG_ANSWER_LOST);
  for (const std::string& line : event.lines) {
    if (!out.text.empty()) out.text += '\n';
    out.text += line;
  }
}
void view(const MaterialsChanged&, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_MATERIALS_CHANGED;
}
void view(const PlayersChanged&, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_PLAYERS_CHANGED;
}
void view(const ClientWarning& event, EventView& out) {
  out.fields.kind = RUNSTONE_EVENT_WARNING;
  out.text = event.text;
}

EventView view_of(const WorldEvent& event) {
  EventView out;
  std::visit([&out](const auto& of) { view(of, out); }, event);
  return out;
}

const WorldEvent& event_at(runstone_client* client, std::size_t index) {
  const auto& drained = live(client, "client").drained;
  if (index >= drained.size())
    refuse(RUNSTONE_NOT_FOUND, "index", "is not that of an event of the last call that drained");
  return drained[index];
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
    if (of.waiting.empty()) {
      auto events = of.client.drain(chunks_max);
      std::move(events.begin(), events.end(), std::back_inserter(of.waiting));
    }
    const std::size_t fitting = std::min(capacity, of.waiting.size());
    of.drained.clear();
    of.drained.reserve(fitting);
    auto* const bytes = reinterpret_cast<std::uint8_t*>(out);
    for (std::size_t i = 0; i < fitting; ++i) {
      of.drained.push_back(std::move(of.waiting.front()));
      of.waiting.pop_front();
      runstone_event fields = view_of(of.drained.back()).fields;
      fields.struct_size = static_cast<std::uint32_t>(event_size);
      std::memcpy(bytes + i * event_size, &fields, sizeof fields);
    }
    *count = fitting;
  });
}

runstone_status runstone_client_event_text(runstone_client* client, size_t index, char* out,
                                           size_t capacity, size_t* count) {
  return answer(
      [&] { write_event_text(view_of(event_at(client, index)).text, out, capacity, count); });
}

runstone_status runstone_client_event_more(runstone_client* client, size_t index, char* out,
                                           size_t capacity, size_t* count) {
  return answer(
      [&] { write_event_text(view_of(event_at(client, index)).more, out, capacity, count); });
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
