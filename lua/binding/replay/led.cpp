#include "lua/binding/replay/led.hpp"

#include "libcdem/ranks/ranks.hpp"
#include "libcdem/step/errors.hpp"
#include "libgeom/core/error.hpp"
#include "libgeom/core/stop.hpp"
#include "lua/binding/replay/journal.hpp"
#include "lua/binding/schema/errors.hpp"

#include <algorithm>
#include <exception>
#include <new>

namespace cdem::script {

namespace {

// How it ended: the first byte that is told. The name follows up to a zero, then the result or the error's text.
enum class End : char {
  result = 'r',
  script_error = 's',
  input_error = 'i',
  file_error = 'f',
  solution_error = 'n',
  interrupted = 'c',
  stopped = 'g',
  no_memory = 'm',
  failure = 'x'
};

thread_local int without_others = 0;

End end_of(const std::exception_ptr& failed, std::string& text) {
  const auto is = [&](End end, const std::exception& error) {
    text = error.what();
    return end;
  };
  try {
    std::rethrow_exception(failed);
  } catch (const Interrupted& error) {
    return is(End::interrupted, error);
  } catch (const geom::Stopped& error) {
    return is(End::stopped, error);
  } catch (const SolutionError& error) {
    return is(End::solution_error, error);
  } catch (const ScriptError& error) {
    return is(End::script_error, error);
  } catch (const FileError& error) {
    return is(End::file_error, error);
  } catch (const geom::InputError& error) {
    return is(End::input_error, error);
  } catch (const std::bad_alloc& error) {
    return is(End::no_memory, error);
  } catch (const std::exception& error) {
    return is(End::failure, error);
  } catch (...) {
    return End::failure;
  }
}

[[noreturn]] void throw_as(End end, const std::string& text) {
  switch (end) {
  case End::script_error:
    throw ScriptError(text);
  case End::input_error:
    throw geom::InputError(text);
  case End::file_error:
    throw FileError(text);
  case End::solution_error:
    throw SolutionError(text);
  case End::interrupted:
    throw Interrupted();
  case End::stopped:
    throw geom::Stopped();
  case End::no_memory:
    throw std::bad_alloc();
  default:
    throw std::runtime_error(text);
  }
}

// Nothing can be told in common any more, so it ends the program, whatever the script would catch.
[[noreturn]] void lost(const std::string& here, const std::string& there) {
  try {
    throw geom::InputError("the script comes to " + here + " where on rank 0 it comes to " +
                           there.substr(std::min<std::size_t>(1, there.size())) +
                           ": it depends on something that is not the same in every process, such as the "
                           "address in tostring of a table");
  } catch (...) {
    std::terminate();
  }
}

std::string lead(const std::string& name, const std::function<std::string()>& work) {
  std::string result;
  std::exception_ptr failed;
  try {
    const WithoutOthers alone;
    result = work();
  } catch (...) {
    failed = std::current_exception();
  }
  End end = End::result;
  std::string text;
  if (failed)
    end = end_of(failed, text);
  std::string told = static_cast<char>(end) + name + '\0' + (failed ? text : result);
  ranks().broadcast(told);
  if (failed)
    std::rethrow_exception(failed);
  return result;
}

std::string follow(const std::string& name) {
  std::string told;
  ranks().broadcast(told);
  const auto zero = told.find('\0');
  if (told.empty() || zero == std::string::npos || told.compare(1, zero - 1, name) != 0)
    lost(name, told.substr(0, zero));
  const End end = static_cast<End>(told.front());
  told.erase(0, zero + 1);
  if (end != End::result)
    throw_as(end, told);
  return told;
}

} // namespace

WithoutOthers::WithoutOthers() {
  ++without_others;
}
WithoutOthers::~WithoutOthers() {
  --without_others;
}

bool with_others() {
  return without_others == 0 && !ranks().alone();
}

std::string led_bytes(const std::string& name, const std::function<std::string()>& work) {
  if (!with_others())
    return work();
  return ranks().leads() ? lead(name, work) : follow(name);
}

Value led(const std::string& name, const std::function<Value()>& work) {
  if (!with_others())
    return work();
  Value value;
  const std::string bytes = led_bytes(name, [&] {
    value = work();
    return value_bytes(value);
  });
  return ranks().leads() ? value : value_from(bytes);
}

void led_act(const std::string& name, const std::function<void()>& work) {
  led_bytes(name, [&] {
    work();
    return std::string();
  });
}

double agreed(double value) {
  if (with_others())
    ranks().largest(&value, 1);
  return value;
}

bool all_fail_here() {
  return !with_others() || ranks().all_fail(Ranks::patience);
}

void require_same(const std::string& what, const std::string& text) {
  if (!with_others())
    return;
  const std::vector<std::string> all = ranks().gather(text);
  for (std::size_t rank = 1; rank < all.size(); ++rank)
    if (all[rank] != all.front())
      throw geom::InputError("rank " + std::to_string(rank) + ": " + what + " differs from that of rank 0");
}

} // namespace cdem::script
