// Work that rank 0 does for all ranks (libcdem/ranks/ranks.hpp): it reads or writes files, asks the clock, or starts
// processes. All ranks call it at the same place of the same script. Rank 0 sends its result or its error to the
// others, so that the script takes the same branches everywhere. A single process just does the work.
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
