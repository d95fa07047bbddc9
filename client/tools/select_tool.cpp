#include "client/tools/select_tool.hpp"

namespace runstone {

ToolEdits SelectTool::plan(const ToolInput&) const { return std::vector<EditDescriptor>{}; }

}  // namespace runstone
