// The module as documents: by topic, with the examples of lua/examples/<topic>.lua; the annotations for editors and the
// reference page.
#pragma once

#include <string>
#include <vector>

namespace cdem::script {

struct Topic {
  std::string file;                 // name of its examples, without ".lua"
  std::string title;                // heading of the reference page
  std::vector<std::string> names{}; // "cdem.grid", "model:fix", in the order of declaration
  std::vector<std::string> classes{};
};

// In the order of module(), which fills them.
const std::vector<Topic>& topics();

// What the examples of a topic begin with, before its first "-- example: NAME" line; "" when there is no such file.
std::string example_preamble(const std::string& topic);
// The lines behind "-- example: NAME"; "" when there are none.
std::string example_of(const std::string& name);
// Names that examples are given for.
std::vector<std::string> examples();

// What the repl says to `help NAME`: call, sentence, fields and example of a function, or the functions of a class or
// topic; a list of topics for "". Throws geom::InputError for another name, with the nearest.
std::string help(const std::string& name);

// LuaCATS annotations of the whole `cdem` module, generated from the same tables that check the arguments.
std::string annotations();
// The reference page of the script language, generated likewise.
std::string reference();

} // namespace cdem::script
