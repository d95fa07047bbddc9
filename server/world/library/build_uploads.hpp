// BuildUploads: takes the files of builds that clients add to the library. A client offers a file,
// sends its bytes, and gets the number of the build when the build is on disk. In between, a worker
// verifies the whole file, and the log writer writes it. Nothing of a file is kept if its offer ends
// before that.
//   - A session has one offer. Another one, or the end of the session, ends it.
//   - kBuildUploadsMax files of all sessions are in memory at a time, and only one of a key and one of
//     an address that others cannot share. Their memory grows as the bytes arrive, up to
//     LibraryLimits::file_bytes_max each.
//   - An offer ends if no byte comes for kUploadSilenceUs, or if the file takes longer than at
//     kUploadBytesPerSecond and kUploadSilenceUs more.
//   - A player whose file held a place for long and was not added waits as long before the next offer.
//   - The limits of the library hold when the file is offered, before it is written, and when the
//     build is added.
// The author of a build that is added is the name of the player: a file may claim another one.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/world/cluster/cluster.hpp"
#include "server/world/commit/changes.hpp"

namespace runstone {

/// Files of all sessions that are received, verified and written at a time.
inline constexpr std::size_t kBuildUploadsMax = 2;
inline constexpr TimeUs kUploadSilenceUs = 30'000'000;
inline constexpr std::uint64_t kUploadBytesPerSecond = 32 * 1024;
/// The longest wait for the log writer, which writes one file at a time.
inline constexpr TimeUs kUploadWriterUs = 60'000'000;
/// A player whose file took kUploadSilenceUs or more and was not added may not offer another one for as
/// long as it took, at most this time.
inline constexpr TimeUs kUploadPauseUsMax = 600'000'000;
/// Pauses that are remembered at a time; the oldest ones are dropped.
inline constexpr std::size_t kUploadPausesMax = 256;

class BuildUploads {
 public:
  /// The parts of the world that uploads use. All must outlive the object.
  struct World {
    WorldEnvironment& environment;
    Sessions& sessions;
    Order& order;
    const Rights& rights;
    Changes& changes;
    const Cluster& cluster;
  };
  explicit BuildUploads(const World& world) : world_(world) {}

  /// Accepts an offer, or refuses it. It ends an earlier offer of the session.
  void on_offer(Session& session, const BuildOffer& offer, const Clocks& now);
  /// Takes the next bytes of the session's file. Ignores them if there is no such offer, or if they do
  /// not follow the bytes before them: an answer that ended the offer may be on its way.
  void on_upload(Session& session, const BuildUpload& upload, const Clocks& now);
  /// Handles the answer to WorldEnvironment::verify_build(). The error is for the client.
  void verified(UploadNumber upload, Result<VerifiedBuild, std::string> result, const Clocks& now);
  /// Handles the answer to WorldEnvironment::save_build_file(). `error` is empty, or why the file was
  /// not written.
  void saved(UploadNumber upload, const std::string& error, const Clocks& now);
  /// Sends the numbers of builds that are on disk now. Call it when the log became durable or failed.
  void send_durable();
  /// Ends offers that take too long, and does what had to wait. Call it on every tick.
  void tick(const Clocks& now);
  /// Ends the offer of a session that is closed.
  void forget(SessionId session) { end_offer(session); }

 private:
  enum class Stage : std::uint8_t {
    receiving,
    verifying,  // a worker has the bytes
    waiting,    // for the log writer
    saving      // the log writer has the file
  };
  struct Upload {
    UploadNumber number{};
    // nullopt: the offer has ended, and a worker or the log writer still has the file.
    std::optional<SessionId> session;
    std::uint32_t request = 0;
    std::uint64_t file_bytes = 0, received = 0;
    PublicKey key{};
    AddressBlock address{};
    Stage stage = Stage::receiving;
    TimeUs began_us = 0, heard_us = 0;  // heard_us: of the last byte, or when `waiting` began
    std::vector<Bytes> parts;           // while receiving: the bytes, in order
    AddBuild build;                     // from `waiting` on
    std::shared_ptr<const Bytes> file;  // while waiting
  };
  /// An added build whose record is not on disk.
  struct Added {
    SessionId session = 0;
    std::uint32_t request = 0;
    std::uint64_t file_bytes = 0;
    Sequence number = 0;
  };
  std::optional<std::string> refusal(const Session& session, std::uint64_t file_bytes) const;
  std::optional<std::string> slot_refusal(const Session& session, const Clocks& now) const;
  Upload* find(UploadNumber upload);
  Upload* receiving(SessionId session, const BuildUpload& upload);
  void answer(Session& session, const BuildAnswer& answer);
  void pause_after(const Upload& upload);
  /// Refuses the upload and removes it.
  void refuse(const Upload& upload, const std::string& why);
  void remove(UploadNumber upload);
  void end_offer(SessionId session);
  std::optional<std::string> lateness(const Upload& upload, const Clocks& now) const;
  /// Gives the file to the log writer if it takes one. Returns why the build may not be added, or
  /// nullopt.
  std::optional<std::string> begin_saving(Upload& upload);
  Result<Sequence, std::string> add(const Upload& upload, const Clocks& now);

  /// A player who may not offer a file now.
  struct Pause {
    PublicKey key{};
    AddressBlock address{};
    TimeUs until_us = 0;
  };

  World world_;
  TimeUs now_us_ = 0;  // of the last tick or offer
  std::vector<Pause> pauses_;
  std::vector<Upload> uploads_;  // at most kBuildUploadsMax
  std::vector<Added> added_;
  std::uint32_t last_number_ = 0;
};

}  // namespace runstone
