#include "common/os/user_folders.hpp"

#include <stdlib.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <optional>
#include <string>

namespace runstone {
namespace {

/// Sets a variable of the environment for one test, or removes it.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Variable() { set(old_ ? old_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) {
    if (value == nullptr) {
      ::unsetenv(name_);
    } else {
      ::setenv(name_, value, 1);
    }
  }
  const char* name_;
  std::optional<std::string> old_;
};

}  // namespace

TEST_CASE("user folders follow the XDG variables, and otherwise HOME", "[os]") {
  const Variable home("HOME", "/home/ana");
  {
    const Variable config("XDG_CONFIG_HOME", "/somewhere/else");
    CHECK(user_folder(UserFolder::config) == "/somewhere/else/runstone");
  }
  const Variable config("XDG_CONFIG_HOME", nullptr), data("XDG_DATA_HOME", nullptr),
      state("XDG_STATE_HOME", nullptr), cache("XDG_CACHE_HOME", "relative/path");
  CHECK(user_folder(UserFolder::config) == "/home/ana/.config/runstone");
  CHECK(user_folder(UserFolder::data) == "/home/ana/.local/share/runstone");
  CHECK(user_folder(UserFolder::state) == "/home/ana/.local/state/runstone");
  CHECK(user_folder(UserFolder::cache) == "/home/ana/.cache/runstone");
  const Variable homeless("HOME", nullptr);
  CHECK(user_folder(UserFolder::data).empty());
}

}  // namespace runstone
