// Work that rank 0 does for all ranks (libcdem/ranks/ranks.hpp): what reads or writes files, asks the clock, starts
// processes. All of them call it at the same place of the same script; the others are told its result or its error, so
// that the script goes the same way everywhere. One process alone just does it.
#pragma once

#include "lua/binding/schema/value.hpp"

#include <functional>

namespace cdem::script {

// `name`: the same on all ranks, else they have gone different ways and are ended. Inside led work all of this is done
// without the others, who wait.
std::string led_bytes(const std::string& name, const std::function<std::string()>& work);
Value led(const std::string& name, const std::function<Value()>& work); // a plain value
void led_act(const std::string& name, const std::function<void()>& work);

// The largest of what the ranks have.
double agreed(double);

// The calling thread does without the others for as long as this lives.
class WithoutOthers {
public:
  WithoutOthers();
  ~WithoutOthers();
  WithoutOthers(const WithoutOthers&) = delete;
  WithoutOthers& operator=(const WithoutOthers&) = delete;
};

bool with_others(); // there are others, and they take part

// An error is on its way: true where every rank has one here, or this one does without the others. Else it has failed alone,
// and must end all.
bool all_fail_here();

// Throws geom::InputError on all ranks where one has come here with another text.
void require_same(const std::string& what, const std::string& text);

} // namespace cdem::script
