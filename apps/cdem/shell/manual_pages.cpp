#include "apps/cdem/shell/manual_pages.hpp"

#include "apps/cdem/process/build_info.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace cdem::app {
namespace {

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

// Text of roff: what would begin a request or an escape is protected, and - stays one that can be copied.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\''))
      out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}
std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string page_head(const std::string& name, const std::string& text) {
  return ".TH " + upper(roff(name)) + " 1 \"\" \"cdem " + version() + "\" \"cdem\"\n.SH NAME\n" + roff(name) +
         " \\- " + roff(text) + "\n";
}

std::string options(const DeclaredCommand& command) {
  std::string text = ".SH OPTIONS\n";
  for (const DeclaredOption& option : command.options) {
    text += ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i)
      text += (i > 0 ? ", " : "") + bold(option.names[i]);
    if (!option.value.empty())
      text += " " + italic(option.value);
    text += "\n" + roff(option.text) + "\n";
  }
  return text;
}

// Paragraphs of the footer: one that begins with a word and a colon alone is a section of lines as they are.
std::string sections(const std::string& footer) {
  std::string text;
  bool in_notes = false;
  std::istringstream in(footer + "\n\n");
  std::string line;
  std::vector<std::string> paragraph;
  while (std::getline(in, line)) {
    if (!line.empty()) {
      paragraph.push_back(line);
      continue;
    }
    if (paragraph.empty())
      continue;
    const bool section = paragraph[0].back() == ':' && paragraph.size() > 1 && paragraph[1][0] == ' ';
    if (section) {
      text += ".SH " + upper(roff(paragraph[0].substr(0, paragraph[0].size() - 1))) + "\n.nf\n";
      paragraph.erase(paragraph.begin());
    } else {
      text += in_notes ? ".PP\n" : ".SH NOTES\n";
    }
    in_notes = !section;
    for (const std::string& each : paragraph)
      text += roff(each) + "\n";
    text += section ? ".fi\n" : "";
    paragraph.clear();
  }
  return text;
}

std::string page_of(const DeclaredCommand& command) {
  std::string text = page_head("cdem-" + command.name, command.text) + ".SH SYNOPSIS\n" +
                     bold("cdem " + command.name) +
                     (command.argument.empty() ? "" : " " + italic(command.argument)) +
                     (command.options.empty() ? "\n" : " [" + italic("OPTIONS") + "]\n");
  if (!command.argument.empty())
    text += ".SH ARGUMENTS\n.TP\n" + italic(command.argument) + "\n" + roff(command.argument_text) + "\n";
  return text + options(command) + sections(command.footer) + ".SH SEE ALSO\n.BR cdem (1)\n";
}

} // namespace

std::map<std::string, std::string> manual_pages(const Declared& all) {
  std::map<std::string, std::string> pages;
  std::string text = page_head("cdem", "continuum-based discrete element method");
  text += ".SH SYNOPSIS\n" + bold("cdem") + " " + italic("COMMAND") + " [...]\n.SH DESCRIPTION\n" +
          roff(all.program.text) + "\n.SH COMMANDS\n";
  std::string also;
  for (const DeclaredCommand& command : all.commands) {
    text += ".TP\n.BR cdem\\-" + command.name + " (1)\n" + roff(command.text) + "\n";
    also += (also.empty() ? ".BR cdem\\-" : " ,\n.BR cdem\\-") + command.name + " (1)";
    pages["cdem-" + command.name + ".1"] = page_of(command);
  }
  pages["cdem.1"] =
      text + options(all.program) + sections(all.program.footer) + ".SH SEE ALSO\n" + also + "\n";
  return pages;
}

} // namespace cdem::app
