// LibraryExchange: a client's use of the library of builds of a world. It lists builds, fetches the
// file of one, and adds a file. It makes the messages and takes the answers; ClientSession carries
// them. One listing, one fetch and one addition may be under way at the same time. Memory: the
// listed builds (kListedMax), and the bytes of two files (kFileBytesMax each). Pure: times are
// arguments, in microseconds of the client's steady clock. One thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The builds that a player looks for: all texts must fit. An empty text fits every build.
struct LibrarySearch {
  std::string name, author;  // parts of these names
  std::string tag;
  friend bool operator==(const LibrarySearch&, const LibrarySearch&) = default;
};

/// The state of a fetch or an addition.
enum class TransferState : std::uint8_t { none, under_way, done, failed };

class LibraryExchange {
 public:
  /// The largest file that this client fetches or adds.
  static constexpr std::uint64_t kFileBytesMax = std::uint64_t{64} << 20;
  /// Builds of one listing, all pages together.
  static constexpr std::size_t kListedMax = 1000;
  /// Requests of pieces, and uploads, that have no answer yet.
  static constexpr std::size_t kUnderWayMax = 4;
  /// A listing, a fetch or an addition fails if nothing arrives for so long. An addition ends with
  /// the server's verification of the file and its write to the disk.
  static constexpr TimeUs kListUsMax = 20'000'000, kFetchUsMax = 30'000'000,
                          kAddUsMax = 120'000'000;

  struct Listing {
    LibrarySearch search;
    std::vector<ListedBuild> builds;  // descending by number
    bool has_more = false;            // list_more() would find further builds
    std::uint64_t total = 0;          // builds in the library
    bool is_waiting = false;          // for an answer
    bool is_known = false;            // a page has arrived
    std::string refusal;              // why the last request failed; empty: it did not
  };
  struct Fetch {
    TransferState state = TransferState::none;
    Sequence number = 0;           // of the build
    std::uint64_t file_bytes = 0;  // 0 until they are known
    Bytes bytes;                   // that have arrived
    std::string refusal;           // of a failed one
  };
  struct Addition {
    TransferState state = TransferState::none;
    std::uint64_t file_bytes = 0, received_bytes = 0;  // received by the server
    Sequence number = 0;                               // of the build, once it is added
    std::string refusal;                               // of a failed one
  };

  /// Begins a new listing. One that has no answer is replaced. Texts that are too long for the
  /// message are cut.
  void list(LibrarySearch search);
  /// Asks for the next page of the listing. Does nothing if there is none, or while one is asked for.
  void list_more();
  /// Begins to fetch the file of a build. An earlier fetch is dropped. The size comes from the
  /// listing; a build that is not listed is looked up first. Fails (Fetch::refusal) if the file has
  /// more than kFileBytesMax.
  void fetch(Sequence number);
  /// Drops the fetch and its bytes.
  void stop_fetch();
  /// Begins to add a file. An addition that is under way is dropped. Requires a file that is not
  /// empty. Fails (Addition::refusal) if it has more than kFileBytesMax.
  void add(Bytes file);
  /// Sends no more of the file. The server forgets it after some time, unless it has all of it.
  void stop_adding();
  /// Returns true if all of the file was sent. The server may then add the build whatever follows.
  bool has_sent_all() const { return !file_.empty() && sent_bytes_ == file_.size(); }

  /// Returns the messages to send now, and ends what got no answer in time.
  std::vector<Message> step(TimeUs now_us);
  /// Take an answer of the server. Answers to other requests change nothing.
  void receive(Builds answer, TimeUs now_us);
  void receive(BuildPiece answer, TimeUs now_us);
  void receive(const BuildAnswer& answer, TimeUs now_us);
  /// Ends what is under way, because its connection ended.
  void disconnected();
  /// Ends what is under way, for this reason.
  void refuse(const std::string& why);
  /// Forgets everything, because the next world is another one.
  void clear();

  const Listing& listing() const { return listing_; }
  const Fetch& fetched() const { return fetch_; }
  const Addition& addition() const { return addition_; }
  /// Returns the bytes of a fetch that is done. The fetch is then TransferState::none.
  Bytes take_file();
  /// Returns true if something is under way or waits to be sent.
  bool is_busy() const;
  /// Returns a number that rises with each change of listing, fetch and addition.
  std::uint64_t serial() const { return serial_; }

 private:
  enum class Page : std::uint8_t { first, next, look_up };
  struct PendingPage {
    std::uint32_t request = 0;
    Page page = Page::first;
    TimeUs sent_us = 0;
  };
  struct PendingPiece {
    std::uint32_t request = 0;
    std::uint64_t offset = 0;
    std::uint64_t fetch = 0;  // the number of its fetch
  };

  void ask_for_page(std::vector<Message>& out, TimeUs now_us);
  void ask_for_pieces(std::vector<Message>& out, TimeUs now_us);
  void send_uploads(std::vector<Message>& out, TimeUs now_us);
  void take_page(Page page, Builds answer);
  void take_look_up(const Builds& answer);
  /// Sets the size of the file that is fetched, or fails.
  void set_file_bytes(std::uint64_t file_bytes);
  void fail_listing(std::string why);
  void fail_fetch(std::string why);
  void fail_addition(std::string why);

  Listing listing_;
  Fetch fetch_;
  Addition addition_;
  std::uint64_t serial_ = 0;
  std::uint32_t requests_ = 0;  // of this connection

  std::optional<Page> wanted_page_;  // of the listing, to be sent
  std::optional<PendingPage> pending_page_;
  bool is_look_up_wanted_ = false;  // of fetch_.number, to be sent

  std::uint64_t fetches_ = 0;        // the number of the newest fetch
  std::uint64_t asked_bytes_ = 0;    // of its file
  std::deque<PendingPiece> pieces_;  // also those of fetches that were dropped
  std::optional<TimeUs> fetch_us_;   // when the fetch advanced last

  Bytes file_;                    // of the addition
  std::uint64_t sent_bytes_ = 0;  // of file_
  std::uint32_t offer_ = 0;       // its request; 0: the offer was not sent
  bool is_offer_accepted_ = false;
  TimeUs add_us_ = 0;  // when the addition advanced last
};

}  // namespace runstone
