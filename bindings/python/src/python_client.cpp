#include "python_client.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "client/api/world_client.hpp"
#include "common/core/material_row.hpp"
#include "common/core/thread_scratch.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "python_chunk.hpp"
#include "python_edit.hpp"
#include "python_mesh.hpp"
#include "python_world.hpp"

namespace runstone::python {
namespace {

/// A pipe in which a byte waits while the client has something to do. The thread of the library
/// writes it without Python's lock, and the loop of asyncio waits for it.
class WakePipe {
 public:
  WakePipe() {
    if (pipe2(ends_.data(), O_NONBLOCK | O_CLOEXEC) != 0)
      throw RunstoneError(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  ~WakePipe() {
    for (const int end : ends_) close(end);
  }
  WakePipe(const WakePipe&) = delete;
  WakePipe& operator=(const WakePipe&) = delete;

  int readable() const { return ends_[0]; }
  void wake() const {
    const char byte = 0;
    // A full pipe wakes the reader already.
    [[maybe_unused]] const auto written = write(ends_[1], &byte, 1);
  }
  void clear() const {
    std::array<char, 256> bytes;
    while (read(ends_[0], bytes.data(), bytes.size()) > 0) {
    }
  }

 private:
  std::array<int, 2> ends_{-1, -1};
};

/// An event, and the materials with which its chunk is meshed.
struct PythonClientEvent {
  WorldEvent event;
  std::shared_ptr<const MeshMaterials> materials;
};
using EventSelf = Self<PythonClientEvent>;

/// The client. Every call is made under the mutex and without Python's lock, so that threads of
/// Python may share a client, and others run while it steps.
class PythonClient {
 public:
  explicit PythonClient(WorldClientOptions options) {
    options.wake = [pipe = pipe_] { pipe->wake(); };
    const py::gil_scoped_release released;
    auto client = WorldClient::connect(std::move(options));
    if (client) {
      client_.emplace(*std::move(client));
    } else {
      error_ = client.error();
    }
  }
  /// Throws if the constructor could not start to connect. The exception is made here, because that
  /// needs Python's lock.
  void check_made() const {
    if (!client_) refuse(error_);
  }
  ~PythonClient() {
    const py::gil_scoped_release released;
    client_.reset();
  }
  PythonClient(const PythonClient&) = delete;
  PythonClient& operator=(const PythonClient&) = delete;

  /// Returns work(client). Throws a ValueError if the client is closed.
  template <class F>
  auto with(F&& work) {
    if (is_closed_) refuse("the client is closed");
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex_);
    return work(*client_);
  }
  void close() {
    if (is_closed_) return;
    is_closed_ = true;
    const py::gil_scoped_release released;
    const std::lock_guard lock(mutex_);
    client_->close();
  }
  bool is_closed() const { return is_closed_; }
  const WakePipe& pipe() const { return *pipe_; }

 private:
  // The thread of the library may wake for as long as the client lives.
  std::shared_ptr<WakePipe> pipe_ = std::make_shared<WakePipe>();
  std::mutex mutex_;
  std::optional<WorldClient> client_;
  std::string error_;
  bool is_closed_ = false;  // under Python's lock
};
using ClientSelf = Self<PythonClient>;

void take(const Result<void, ClientRefusal>& done) {
  if (!done) throw RunstoneError(done.error().text);
}

std::uint8_t view_radius_of(std::int64_t radius) {
  if (radius < 0 || radius > 64)
    refuse("a radius of the view is 0 to 64 chunks, got " + std::to_string(radius));
  return static_cast<std::uint8_t>(radius);
}

Encryption encryption_of(const std::string& word) {
  if (word == "any certificate") return Encryption::any_certificate;
  if (word == "authorities") return Encryption::authorities;
  if (word == "none") return Encryption::none;
  refuse("encryption is \"any certificate\", \"authorities\" or \"none\", got \"" + word + "\"");
}

std::uint64_t mebibytes_of(std::int64_t count, const char* name) {
  if (count < 1) refuse(std::string(name) + " is at least 1, got " + std::to_string(count));
  return static_cast<std::uint64_t>(count);
}

std::shared_ptr<PythonClient> make_client(
    const std::string& server, const std::string& name, const std::string& invite,
    const std::string& password, const std::string& key_file, const std::string& encryption,
    const std::string& authorities_file, const std::array<std::int64_t, 2>& view_radii,
    std::int64_t memory_mib, const std::string& cache_folder, std::int64_t cache_mib) {
  WorldClientOptions options;
  options.server = server;
  options.name = name;
  options.invite = invite;
  options.password = password;
  options.key_file = key_file;
  options.encryption = encryption_of(encryption);
  options.authorities_file = authorities_file;
  options.view_radius = view_radius_of(view_radii[0]);
  options.view_radius_vertical = view_radius_of(view_radii[1]);
  options.memory_mib = mebibytes_of(memory_mib, "memory_mib");
  options.cache_folder = cache_folder;
  options.cache_mib = mebibytes_of(cache_mib, "cache_mib");
  auto out = std::make_shared<PythonClient>(std::move(options));
  out->check_made();
  return out;
}

py::tuple key_tuple(const ChunkCoord& at) { return py::make_tuple(at.x, at.y, at.z); }

ChunkCoord key_of(const Triple& key) {
  for (const std::int64_t along : key) {
    if (along < std::numeric_limits<std::int32_t>::min() ||
        along > std::numeric_limits<std::int32_t>::max())
      refuse("the chunk " + text_of(key) + " is outside the world");
  }
  return {static_cast<std::int32_t>(key[0]), static_cast<std::int32_t>(key[1]),
          static_cast<std::int32_t>(key[2])};
}

py::tuple place_tuple(const ClientPlace& place) {
  return py::make_tuple(place.at.x, place.at.y, place.at.z, place.yaw_degrees, place.pitch_degrees);
}

py::object chunk_object(const std::shared_ptr<const RunChunk>& chunk) {
  if (chunk == nullptr) return py::none();
  return py::cast(make_chunk(*chunk));
}

// Events.

const char* kind_of(const WorldEvent& event) {
  struct Kinds {
    const char* operator()(const WorldOpened&) const { return "opened"; }
    const char* operator()(const ConnectionLost&) const { return "lost"; }
    const char* operator()(const ChunkChanged&) const { return "chunk"; }
    const char* operator()(const ChunkRemoved&) const { return "chunk removed"; }
    const char* operator()(const ChunkMissing&) const { return "chunk missing"; }
    const char* operator()(const EditConfirmed&) const { return "edit confirmed"; }
    const char* operator()(const EditRejected&) const { return "edit rejected"; }
    const char* operator()(const EditDurable&) const { return "edit durable"; }
    const char* operator()(const EditUnseen&) const { return "edit unseen"; }
    const char* operator()(const OthersEdit&) const { return "others edit"; }
    const char* operator()(const ChatReceived&) const { return "chat"; }
    const char* operator()(const CommandDone&) const { return "command done"; }
    const char* operator()(const MaterialsChanged&) const { return "materials"; }
    const char* operator()(const PlayersChanged&) const { return "players"; }
    const char* operator()(const ClientWarning&) const { return "warning"; }
  };
  return std::visit(Kinds{}, event);
}

const MeshSource& source_of(const EventSelf& self) {
  const auto* const changed = std::get_if<ChunkChanged>(&self->event);
  if (changed == nullptr)
    refuse(std::string("an event of kind \"") + kind_of(self->event) + "\" has no chunk");
  return changed->source;
}

py::object event_key(const EventSelf& self) {
  if (const auto* const changed = std::get_if<ChunkChanged>(&self->event))
    return key_tuple(changed->source.at);
  if (const auto* const removed = std::get_if<ChunkRemoved>(&self->event))
    return key_tuple(removed->at);
  if (const auto* const missing = std::get_if<ChunkMissing>(&self->event))
    return key_tuple(missing->at);
  return py::none();
}

py::object event_cause(const EventSelf& self) {
  const auto* const changed = std::get_if<ChunkChanged>(&self->event);
  if (changed == nullptr) return py::none();
  switch (changed->cause) {
    case ChangeCause::own_edit:
      return py::str("own edit");
    case ChangeCause::others_edit:
      return py::str("others edit");
    default:
      return py::str("terrain");
  }
}

/// Returns the number that `field` reads, or None for events without it.
template <class Field>
py::object number_or_none(const WorldEvent& event, Field field) {
  return std::visit(
      [&](const auto& of) -> py::object {
        if constexpr (requires { field(of); }) {
          return py::int_(field(of));
        } else {
          return py::none();
        }
      },
      event);
}

py::object event_edit(const EventSelf& self) {
  return number_or_none(self->event, [](const auto& of) -> decltype(of.edit) { return of.edit; });
}

py::object event_sequence(const EventSelf& self) {
  return number_or_none(self->event,
                        [](const auto& of) -> decltype(of.sequence) { return of.sequence; });
}

py::list event_chunks(const EventSelf& self) {
  py::list out;
  if (const auto* const edit = std::get_if<OthersEdit>(&self->event)) {
    for (const ChunkCoord& at : edit->chunks) out.append(key_tuple(at));
  }
  return out;
}

std::string event_text(const EventSelf& self) {
  return std::visit(
      [](const auto& of) -> std::string {
        if constexpr (requires { of.text; }) {
          return of.text;
        } else if constexpr (requires { of.headline; }) {
          return of.detail.empty() ? of.headline : of.headline + ": " + of.detail;
        } else if constexpr (requires { of.lines; }) {
          std::string out;
          for (const std::string& line : of.lines) out += (out.empty() ? "" : "\n") + line;
          return out;
        } else {
          return {};
        }
      },
      self->event);
}

std::string event_name(const EventSelf& self) {
  if (const auto* const chat = std::get_if<ChatReceived>(&self->event)) return chat->name;
  if (const auto* const rejected = std::get_if<EditRejected>(&self->event)) return rejected->reason;
  return {};
}

bool event_is_final(const EventSelf& self) {
  const auto* const lost = std::get_if<ConnectionLost>(&self->event);
  return lost != nullptr && lost->is_final;
}

bool event_is_ok(const EventSelf& self) {
  const auto* const done = std::get_if<CommandDone>(&self->event);
  return done == nullptr || (done->is_ok && !done->is_answer_lost);
}

py::object event_author(const EventSelf& self) {
  const auto* const edit = std::get_if<OthersEdit>(&self->event);
  return edit == nullptr ? py::object(py::none()) : py::object(py::int_(edit->author));
}

std::shared_ptr<PythonMesh> event_mesh(const EventSelf& self) {
  const MeshSource& source = source_of(self);
  auto out = std::make_shared<PythonMesh>();
  const py::gil_scoped_release released;
  with_scratch<ChunkMeshScratch>([&](ChunkMeshScratch& scratch) {
    mesh_chunk(*source.chunk, source.beside(), {}, *self->materials, scratch, out->mesh);
  });
  return out;
}

void define_event(py::module_& module) {
  py::class_<PythonClientEvent, std::shared_ptr<PythonClientEvent>>(
      module, "ClientEvent", "What happened to a client. docs/python.md lists the kinds.")
      .def_property_readonly(
          "kind", [](const EventSelf& self) { return kind_of(self->event); },
          "The kind, such as \"opened\", \"chunk\" or \"chat\".")
      .def_property_readonly("key", &event_key,
                             "The place of a chunk in the grid of chunks, for \"chunk\", \"chunk "
                             "removed\" and \"chunk missing\"; otherwise None.")
      .def_property_readonly("cause", &event_cause,
                             "Why a chunk changed: \"terrain\", \"own edit\" or \"others edit\"; "
                             "otherwise None.")
      .def_property_readonly(
          "chunk", [](const EventSelf& self) { return chunk_object(source_of(self).chunk); },
          "The Chunk of the kind \"chunk\". Raise ValueError for other kinds.")
      .def_property_readonly(
          "neighbours",
          [](const EventSelf& self) {
            py::list out;
            for (const auto& neighbour : source_of(self).neighbours)
              out.append(chunk_object(neighbour));
            return out;
          },
          "The six chunks beside it, as Chunk.mesh() takes them. Raise ValueError for other kinds.")
      .def("mesh", &event_mesh,
           "Return the mesh of the chunk with the materials of the world. Raise ValueError for "
           "kinds other than \"chunk\".")
      .def_property_readonly("edit", &event_edit, "The number of an edit of this client, or None.")
      .def_property_readonly("sequence", &event_sequence,
                             "The place of an edit in the log of the world, or None.")
      .def_property_readonly("author", &event_author,
                             "The author of an edit of others, 0 for the server; otherwise None.")
      .def_property_readonly("chunks", &event_chunks, "The chunks that an edit of others changed.")
      .def_property_readonly("text", &event_text,
                             "Words for the player: a line of the chat, the answer of a command, "
                             "or why an edit or a connection failed.")
      .def_property_readonly("name", &event_name,
                             "The player who wrote a line of the chat, or the name of the reason "
                             "of a rejected edit.")
      .def_property_readonly("is_final", &event_is_final,
                             "True if the connection was lost for good.")
      .def_property_readonly("is_ok", &event_is_ok,
                             "False for a command that failed or whose answer was lost.")
      .def("__repr__", [](const EventSelf& self) {
        std::string out = std::string("<runstone.ClientEvent \"") + kind_of(self->event) + "\"";
        const py::object key = event_key(self);
        if (!key.is_none()) out += " " + std::string(py::str(key));
        const std::string text = event_text(self);
        if (!text.empty()) out += ": " + text;
        return out + ">";
      });
}

// The client.

std::vector<std::shared_ptr<PythonClientEvent>> drained(const ClientSelf& self,
                                                        std::int64_t chunks_max) {
  const std::size_t most = chunks_max < 0 ? 0 : static_cast<std::size_t>(chunks_max);
  return self->with([&](WorldClient& client) {
    std::vector<std::shared_ptr<PythonClientEvent>> out;
    for (WorldEvent& event : client.drain(most)) {
      out.push_back(std::make_shared<PythonClientEvent>(
          PythonClientEvent{std::move(event), client.mesh_materials()}));
    }
    return out;
  });
}

py::object world_dict(const ClientSelf& self) {
  const std::optional<ClientWorld> world =
      self->with([](WorldClient& client) { return client.world(); });
  if (!world) return py::none();
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string id;
  for (const std::uint8_t byte : world->id) {
    id += kDigits[byte >> 4];
    id += kDigits[byte & 15];
  }
  py::dict out;
  out["id"] = id;
  out["edge"] = world->chunk_edge;
  out["y_min"] = world->y_min;
  out["y_max"] = world->y_max;
  out["edit_volume_max"] = world->edit_volume_max;
  out["spawn"] = py::make_tuple(world->spawn.x, world->spawn.y, world->spawn.z);
  out["author"] = world->author;
  out["name"] = world->name;
  out["fingerprint"] = world->server_fingerprint;
  return out;
}

std::vector<std::shared_ptr<PythonMaterial>> material_list(const ClientSelf& self) {
  const std::vector<MaterialRow> rows =
      self->with([](WorldClient& client) { return client.materials(); });
  std::vector<std::shared_ptr<PythonMaterial>> out;
  for (std::size_t id = 0; id < rows.size(); ++id) {
    out.push_back(std::make_shared<PythonMaterial>(PythonMaterial{
        static_cast<std::int64_t>(id), rows[id].name, rows[id].colour, rows[id].visibility}));
  }
  return out;
}

py::list player_list(const ClientSelf& self) {
  py::list out;
  for (const PlayerInfo& player :
       self->with([](WorldClient& client) { return client.players(); })) {
    py::dict row;
    row["author"] = player.author;
    row["name"] = player.name;
    row["role"] = player.role;
    row["place"] = player.place ? py::object(place_tuple(*player.place)) : py::object(py::none());
    out.append(row);
  }
  return out;
}

std::uint64_t submitted(const ClientSelf& self, const Self<PythonEdit>& edit,
                        const std::optional<std::uint64_t>& action) {
  const auto number = self->with(
      [&](WorldClient& client) { return client.submit(edit->edit, action.value_or(0)); });
  if (!number) throw RunstoneError(number.error().text);
  return *number;
}

}  // namespace

void define_client(py::module_& module) {
  define_event(module);
  py::class_<PythonClient, std::shared_ptr<PythonClient>> core(
      module, "ClientCore", "The client without asyncio, for runstone.Client.");
  core.attr("NEW_ACTION") = kNewAction;
  core.def(py::init(&make_client), py::arg("server"), py::arg("name"), py::arg("invite"),
           py::arg("password"), py::arg("key_file"), py::arg("encryption"),
           py::arg("authorities_file"), py::arg("view_radii"), py::arg("memory_mib"),
           py::arg("cache_folder"), py::arg("cache_mib"))
      .def("close", [](const ClientSelf& self) { self->close(); })
      .def_property_readonly("closed", [](const ClientSelf& self) { return self->is_closed(); })
      .def("fileno", [](const ClientSelf& self) { return self->pipe().readable(); })
      .def("clear", [](const ClientSelf& self) { self->pipe().clear(); })
      .def("step",
           [](const ClientSelf& self) {
             return self->with([](WorldClient& client) {
               client.step();
               return client.has_more();
             });
           })
      .def("drain", &drained)
      .def_property_readonly("state",
                             [](const ClientSelf& self) {
                               const auto state =
                                   self->with([](WorldClient& client) { return client.state(); });
                               return state == ConnectionState::open         ? "open"
                                      : state == ConnectionState::connecting ? "connecting"
                                                                             : "ended";
                             })
      .def_property_readonly(
          "is_complete",
          [](const ClientSelf& self) {
            return self->with([](WorldClient& client) { return client.is_complete(); });
          })
      .def_property_readonly(
          "outdated_count",
          [](const ClientSelf& self) {
            return self->with([](WorldClient& client) { return client.outdated_count(); });
          })
      .def_property_readonly("world", &world_dict)
      .def_property_readonly("materials", &material_list)
      .def_property_readonly("players", &player_list)
      .def_property_readonly(
          "place",
          [](const ClientSelf& self) {
            return place_tuple(self->with([](WorldClient& client) { return client.place(); }));
          })
      .def("move",
           [](const ClientSelf& self, double x, double y, double z, double yaw, double pitch) {
             take(self->with(
                 [&](WorldClient& client) { return client.move({{x, y, z}, yaw, pitch}); }));
           })
      .def("set_view",
           [](const ClientSelf& self, std::int64_t radius, std::int64_t vertical) {
             const std::uint8_t h = view_radius_of(radius), v = view_radius_of(vertical);
             take(self->with([&](WorldClient& client) { return client.set_view_radii(h, v); }));
           })
      .def("submit", &submitted)
      .def("wait_us",
           [](const ClientSelf& self, const Self<PythonEdit>& edit) {
             return self->with([&](WorldClient& client) { return client.wait_us(edit->edit); });
           })
      .def("chat",
           [](const ClientSelf& self, const std::string& line) {
             take(self->with([&](WorldClient& client) { return client.chat(line); }));
           })
      .def("command",
           [](const ClientSelf& self, const std::string& text) {
             take(self->with([&](WorldClient& client) { return client.command(text); }));
           })
      .def("chunk",
           [](const ClientSelf& self, const Triple& key) {
             const ChunkCoord at = key_of(key);
             return chunk_object(self->with([&](WorldClient& client) { return client.chunk(at); }));
           })
      .def("chunks",
           [](const ClientSelf& self) {
             py::list out;
             for (const ChunkCoord& at :
                  self->with([](WorldClient& client) { return client.chunks(); }))
               out.append(key_tuple(at));
             return out;
           })
      .def("material_at",
           [](const ClientSelf& self, const Triple& at) {
             const VoxelPos voxel = position_of(at);
             return self->with([&](WorldClient& client) { return client.material_at(voxel); });
           })
      .def("find_material", [](const ClientSelf& self, const std::string& name) {
        return self->with([&](WorldClient& client) { return client.find_material(name); });
      });
}

}  // namespace runstone::python
