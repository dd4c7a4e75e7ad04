// A solving call as a numbered stage.
#pragma once

#include "lua/binding/functions/solving_warnings.hpp"
#include "lua/binding/module/record.hpp"
#include "lua/binding/session/model_object.hpp"

#include <functional>

namespace cdem::script {

extern const Record<Stage> stage_record;
extern const Record<RelaxResult> relax_record;

// Runs `solve` as the next stage, whose callbacks go through Checkpoints::call_back; in a check, calls each of them once
// with `tried` and returns `empty` instead. The history is written however the stage ends; a model whose stage ended
// early is kept, so that its last good state can be saved.
Value stage(Session&, ModelObject&, const char* kind, const Arguments&, const Value& empty,
            const std::function<Value(Simulation&)>& solve, const Checkpoints::Callbacks& = {},
            const Values& tried = {});

} // namespace cdem::script
