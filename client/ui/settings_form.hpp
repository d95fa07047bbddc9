// SettingsForm: the controls of the settings window. It changes a copy, which the user keeps or
// drops. One thread.
#pragma once
#include "client/settings/client_settings.hpp"

namespace runstone {

class SettingsForm {
 public:
  enum class Result { open, kept, dropped };

  void begin(const ClientSettings& settings) { edited_ = settings; }
  /// Makes the controls with ImGui in the current window.
  Result build(double scale);
  const ClientSettings& edited() const { return edited_; }

 private:
  ClientSettings edited_;
};

}  // namespace runstone
