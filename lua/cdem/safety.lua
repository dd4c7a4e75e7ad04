-- cdem.factor_of_safety: strength reduction by bisection. Trials run one after another, each on all threads of the run,
-- because the next trial depends on the last verdict. The steps of a trial share the cores, with the same bits for
-- every number of threads. So the result does not depend on the machine.
local cdem = ...

local checked = cdem.factor_of_safety -- its arguments, tried

local function text(factor) return string.format("F = %.4g", factor) end

-- The displacement of the failing side, drawn a twentieth of the model large.
local function draw(model, file, factor)
  local size = model:box().max
  local least, moved = model:box().min, model:max("displacement.magnitude")
  local length = math.max(size[1] - least[1], size[2] - least[2], size[3] - least[3])
  local times = moved > 0 and tonumber(string.format("%.2g", 0.05 * length / moved)) or 0
  model:picture{ file = file, up = "z", colour = "displacement.magnitude", broken_bonds = false, deformation = times,
                 size = {1600, 0}, title = "Mechanism, " .. text(factor) }
end

function cdem.factor_of_safety(options)
  local o = checked(options)
  local trials, sides = {}, {}

  -- Is the model stable with its strengths divided by the factor? nil in a check, which solves nothing.
  local function try(factor)
    local model = o.model and o.model:copy() or o.builder()
    model:reduce_strength{ factor = factor, reduce = o.reduce }
    model:reset_displacement()
    local r = model:relax{ residual = o.residual, max_steps = o.max_steps, trial = text(factor) }
    if r.steps == 0 then
      sides = { stable = model, failing = model }
      return nil
    end
    trials[#trials + 1] = { factor = factor, verdict = r.verdict, steps = r.steps, residual = r.residual }
    sides[r.verdict == "stable" and "stable" or "failing"] = model
    return r.verdict == "stable"
  end

  local lower, upper = o.lower, o.upper
  local stands = try(lower)
  if stands == nil then -- a check
    if o.picture then draw(sides.failing, o.picture, upper) end
    return { factor = lower, lower = lower, upper = upper, stable = sides.stable, failing = sides.failing, trials = {} }
  end
  if not stands then
    if o.picture then draw(sides.failing, o.picture, lower) end
    error(string.format("cdem.factor_of_safety: lower = %.6g: the model is %s there already, so the factor is below it; "
                        .. "look at %s, and give a smaller lower", lower, trials[1].verdict,
                        o.picture or "what moves there (picture = \"mechanism.png\")"), 2)
  end
  if try(upper) then
    error(string.format("cdem.factor_of_safety: upper = %.6g: the model is stable there still, so the factor is above "
                        .. "it; give a larger upper", upper), 2)
  end
  while upper - lower > o.tolerance do
    local middle = 0.5 * (lower + upper)
    if try(middle) then lower = middle else upper = middle end
  end

  local factor = 0.5 * (lower + upper)
  cdem.log(string.format("factor of safety %.4g: stable at %.4g, failing at %.4g, %d trials", factor, lower, upper,
                         #trials))
  cdem.report{ { name = o.figure, value = factor }, { name = o.figure .. "_lower", value = lower },
               { name = o.figure .. "_upper", value = upper } }
  if o.picture then draw(sides.failing, o.picture, upper) end
  return { factor = factor, lower = lower, upper = upper, stable = sides.stable, failing = sides.failing,
           trials = trials }
end
