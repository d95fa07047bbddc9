// A strict reader of the XML that charts write, so that tests can check what is drawn. It knows no
// comments, CDATA or declarations, which charts do not write.
#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace runstone::bench::chart {

struct Element {
  std::string name = {};
  std::map<std::string, std::string> attributes = {};
  std::string text = {};
  std::size_t depth = 0;

  [[nodiscard]] std::string at(const std::string& key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? "" : found->second;
  }
  [[nodiscard]] double number(const std::string& key) const { return std::stod(at(key)); }
  [[nodiscard]] bool has_class(const std::string& name_of_class) const {
    return (" " + at("class") + " ").find(" " + name_of_class + " ") != std::string::npos;
  }
};

struct SvgText {
  std::vector<Element> elements = {};  // in the order of their opening tags
  std::string error = {};              // empty if well-formed

  [[nodiscard]] std::vector<Element> named(const std::string& name) const {
    std::vector<Element> out;
    for (const Element& element : elements) {
      if (element.name == name) out.push_back(element);
    }
    return out;
  }
  [[nodiscard]] std::vector<Element> with_class(const std::string& name) const {
    std::vector<Element> out;
    for (const Element& element : elements) {
      if (element.has_class(name)) out.push_back(element);
    }
    return out;
  }
  [[nodiscard]] bool has_text(const std::string& text) const {
    for (const Element& element : elements) {
      if (element.text == text) return true;
    }
    return false;
  }
};

class SvgReader {
 public:
  explicit SvgReader(std::string_view text) : rest_(text) {}

  SvgText read() {
    while (out_.error.empty() && !rest_.empty()) step();
    if (out_.error.empty() && !open_.empty()) out_.error = "an element is still open";
    if (out_.error.empty() && roots_ != 1) out_.error = "there is not one root";
    return out_;
  }

 private:
  void step() {
    if (rest_.starts_with("</")) return close();
    if (rest_.starts_with("<")) return open();
    const std::string text = unescaped(take_until('<'));
    if (open_.empty()) {
      fail("text outside");
    } else {
      out_.elements[open_.back()].text += text;
    }
  }

  void open() {
    rest_.remove_prefix(1);
    Element element;
    element.name = take_name();
    element.depth = open_.size();
    while (out_.error.empty() && rest_.starts_with(" ")) {
      rest_.remove_prefix(1);
      const std::string key = take_name();
      if (!rest_.starts_with("=\"")) return fail("an attribute without a value");
      rest_.remove_prefix(2);
      const std::string value = unescaped(take_until('"'));
      if (rest_.empty()) return fail("an attribute without an end");
      rest_.remove_prefix(1);
      if (!element.attributes.emplace(key, value).second) return fail("an attribute twice");
    }
    roots_ += open_.empty() ? 1 : 0;
    out_.elements.push_back(element);
    if (rest_.starts_with("/>")) {
      rest_.remove_prefix(2);
    } else if (rest_.starts_with(">")) {
      rest_.remove_prefix(1);
      open_.push_back(out_.elements.size() - 1);
    } else {
      fail("a tag without an end");
    }
  }

  void close() {
    rest_.remove_prefix(2);
    const std::string name = take_name();
    if (!rest_.starts_with(">") || open_.empty() || out_.elements[open_.back()].name != name) {
      return fail("a closing tag that opens nothing");
    }
    rest_.remove_prefix(1);
    open_.pop_back();
  }

  std::string take_name() {
    std::size_t length = 0;
    const auto is_name = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '-' || c == ':';
    };
    while (length < rest_.size() && is_name(rest_[length])) ++length;
    if (length == 0) fail("no name");
    const std::string out(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return out;
  }

  std::string take_until(char end) {
    const std::size_t length = std::min(rest_.find(end), rest_.size());
    const std::string out(rest_.substr(0, length));
    rest_.remove_prefix(length);
    return out;
  }

  std::string unescaped(std::string_view text) {
    static const std::map<std::string, char> kNames = {
        {"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"#39", '\''}};
    std::string out;
    for (std::size_t at = 0; at < text.size(); ++at) {
      const char c = text[at];
      if (c == '<' || c == '>' || (static_cast<unsigned char>(c) < 0x20))
        fail("a character that is not escaped");
      if (c != '&') {
        out += c;
        continue;
      }
      const std::size_t end = text.find(';', at);
      const auto name = end == std::string_view::npos
                            ? kNames.end()
                            : kNames.find(std::string(text.substr(at + 1, end - at - 1)));
      if (name == kNames.end()) {
        fail("a reference to nothing");
        return out;
      }
      out += name->second;
      at = end;
    }
    return out;
  }

  void fail(const char* what) {
    if (out_.error.empty())
      out_.error = std::string(what) + " before: " + std::string(rest_.substr(0, 60));
    rest_ = {};
  }

  std::string_view rest_;
  SvgText out_;
  std::vector<std::size_t> open_;
  int roots_ = 0;
};

inline SvgText read_svg(std::string_view text) { return SvgReader(text).read(); }

}  // namespace runstone::bench::chart
