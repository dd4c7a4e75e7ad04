-- All six set-ups of Feng 2014 section 3, hold and ramp, beside the paper's Table 2; what the figures depend on.
--
--   ./cdem run examples/armour_unit/study.lua [--set groups=all] [--set fineness=10]
--
-- Cases run side by side, one on each processor.
local cdem = require "cdem"
local unit = require "unit"

local groups = cdem.parameter{ name = "groups", default = "cases", choices = {"cases", "sensitivity", "meshes", "all"},
                               doc = "cases: the six, hold and ramp; sensitivity: of case 1; meshes: the six with three meshes" }
local fineness = cdem.parameter{ name = "fineness", default = 16.5, range = {3, 60},
                                 doc = "height over the edge length of the tetrahedra" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 0.0, range = {0, 1e6}, unit = "J/m2",
                                  doc = "above 0: of cohesive units instead of brittle ones" }
local finenesses = cdem.parameter{ name = "finenesses", default = {10.0, 12.5, 16.5}, range = {3, 60},
                                   doc = "of the meshes compared" }

local wanted = {}
for _, group in ipairs{ "cases", "sensitivity", "meshes" } do wanted[group] = groups == group or groups == "all" end
local modes = {"hold", "ramp"}

-- One row per run: what it is for, and its settings.
local runs, settings = {}, {}
local function add(key, changes)
  local set = { case = 1, mode = "hold", fineness = fineness, pictures = false }
  if toughness > 0 then set.bonds, set.fracture_energy = "cohesive", toughness end
  for name, value in pairs(changes) do set[name] = value end
  runs[#runs + 1], settings[#settings + 1] = key, set
end
if wanted.cases then
  for n in ipairs(unit.cases) do
    for _, mode in ipairs(modes) do add({ "case", n, mode }, { case = n, mode = mode, pictures = true }) end
  end
end
local half = { tensile_strength = unit.tensile_strength / 2, cohesion = unit.cohesion / 2, pressure_rate = 2.5e6 }
local changes = {
  { name = "tensile_half", set = { tensile_strength = unit.tensile_strength / 2 } },
  { name = "all_strength_half", set = half },
  { name = "rate_fifth", set = { pressure_rate = 1e6 } },
  { name = "rate_fourfold", set = { pressure_rate = 2e7 } },
  { name = "no_damping", set = { local_damping = 0.0 } },
  { name = "damping_0.2", set = { local_damping = 0.2 } },
  { name = "damping_0.8", set = { local_damping = 0.8 } },
  { name = "beta_3", set = { stiffness_ratio = 3.0 } },
  { name = "beta_30", set = { stiffness_ratio = 30.0 } },
  { name = "twice_the_height", set = { mass = 40000.0, pressure_rate = 2.5e6 } },
  { name = "slender", set = { shape = "slender" } },
}
if wanted.sensitivity then
  for _, mode in ipairs(modes) do
    add({ "change", "none", mode }, { mode = mode })
    for _, change in ipairs(changes) do
      local set = { mode = mode }
      for name, value in pairs(change.set) do set[name] = value end
      add({ "change", change.name, mode }, set)
    end
  end
end
if wanted.meshes then
  for _, f in ipairs(finenesses) do
    for n in ipairs(unit.cases) do
      for _, mode in ipairs(modes) do add({ "mesh", n, mode, f }, { case = n, mode = mode, fineness = f }) end
    end
  end
end

local found = {} -- "case 1 hold" -> figures of that run
local results = cdem.sweep{ script = "case.lua", set = settings }
for i, result in ipairs(results) do
  found[table.concat(runs[i], " ")] = { figures = result.figures, folder = result.output }
end
local function velocity(key, n, mode)
  local run = found[key]
  return run and run.figures["case_" .. n .. "_" .. mode .. "_m_per_s"]
end

-- Young's modulus that bonds on every face leave, from a pulled prism of the same material.
local function effective_modulus(beta)
  local model = cdem.model{ bodies = { {
    shape = cdem.box_mesh{ size = {1, 1, 2}, divisions = {4, 4, 8}, jitter = 0.15 }, bonds = "springs",
    material = cdem.elastic{ youngs_modulus = unit.youngs_modulus, poissons_ratio = unit.poissons_ratio, density = unit.density },
    stiffness_ratio = beta,
    joint = cdem.mohr_coulomb{ cohesion = unit.cohesion, friction_angle = unit.friction_angle,
                               tensile_strength = unit.tensile_strength } } } }
  model:fix{ on = "z-", axes = "z" }
  model:fix{ on = cdem.select.box{ min = {0, 0, 0}, max = {0, 0, 0} }, axes = "xy" }
  model:fix{ on = cdem.select.box{ min = {1, 0, 0}, max = {1, 0, 0} }, axes = "y" }
  model:traction{ on = "z+", stress = {0, 0, 1e5} }
  model:relax{ residual = 1e-6, breaking = false }
  return 1e5 / (model:mean("displacement.z", "z+") / 2)
end

local figures = {}
local function figure(row) figures[#figures + 1] = row end

if wanted.cases then
  local paper = cdem.read_csv("feng2014_single_unit.csv").critical_velocity_m_per_s
  local curves = {}
  for n, case in ipairs(unit.cases) do
    for _, mode in ipairs(modes) do
      figure{ name = "case_" .. n .. "_" .. mode .. "_m_per_s", value = velocity("case " .. n .. " " .. mode, n, mode),
              unit = "m/s", reference = paper[n], kind = "paper", source = "Feng 2014 table 2, without ramp rate or criterion" }
    end
    local hold = found["case " .. n .. " hold"]
    figure{ name = "case_" .. n .. "_first_break_m_per_s", value = hold.figures["case_" .. n .. "_first_break_hold_m_per_s"],
            unit = "m/s" }
    figure{ name = "case_" .. n .. "_place", value = hold.figures["case_" .. n .. "_place"], reference = case.place,
            kind = "paper", source = "Feng 2014 section 3.3, in words" }
    if velocity("case " .. n .. " hold", n, "hold") then -- not where a run failed, or was only checked
      local curve = cdem.read_csv(hold.folder .. "/hold_curve.csv")
      local along = ({"x", "y", "z"})[case.flow[1] + case.flow[2] * 2 + case.flow[3] * 3]
      curves[#curves + 1] = { name = n .. ": " .. case.held .. " held, flow along " .. along, x = curve.velocity,
                              y = curve.displacement }
    end
  end
  for _, edge in ipairs{ math.min(table.unpack(paper)), math.max(table.unpack(paper)) } do
    curves[#curves + 1] = { name = string.format("paper's %s, %.1f m/s", edge < 22 and "lowest" or "highest", edge),
                            x = {edge, edge}, y = {0, 2e-3}, style = "dashed", colour = {0.4, 0.4, 0.4} }
  end
  cdem.chart{ file = "velocity_displacement.png", title = "Six set-ups, hold", x_label = "velocity of the flow (m/s)",
              y_label = "mean displacement under the flow (m)", y_range = {0, 2e-3}, series = curves, legend = "top_left" }
  local one = found["case 1 hold"].figures
  figure{ name = "tets", value = one.tets, reference = 9817, kind = "paper", source = "a mesh of their own" }
  figure{ name = "nodes", value = one.nodes, reference = 2141, kind = "paper", source = "a mesh of their own" }
  figure{ name = "principal_inertia_ratio_max", value = one.principal_inertia_ratio_max }
end

if wanted.sensitivity then
  figure{ name = "effective_modulus_over_E", value = effective_modulus(10) / unit.youngs_modulus, reference = 1 / (1 + 1 / 10),
          kind = "formula", source = "1 / (1 + 1 / beta), beta = 10", tolerance = 0.05 }
  for _, mode in ipairs(modes) do
    local base = velocity("change none " .. mode, 1, mode)
    figure{ name = "unchanged_" .. mode .. "_m_per_s", value = base, unit = "m/s" }
    for _, change in ipairs(changes) do
      local v = velocity("change " .. change.name .. " " .. mode, 1, mode)
      local exact = change.name == "all_strength_half" and math.sqrt(0.5) or change.name == "twice_the_height" and 1 or nil
      figure{ name = change.name .. "_ratio_" .. mode, value = v and base and v / base,
              reference = mode == "hold" and exact or nil, kind = "formula",
              source = "statics: pressure scales with strength, not with size", tolerance = 0.02 }
    end
  end
end

if wanted.meshes then
  for n in ipairs(unit.cases) do
    for _, mode in ipairs(modes) do
      for _, f in ipairs(finenesses) do
        local key = "mesh " .. n .. " " .. mode .. " " .. f
        local run = found[key]
        if run then
          figure{ name = string.format("case_%d_%s_fineness_%g_m_per_s", n, mode, f), value = velocity(key, n, mode),
                  unit = "m/s" }
          figure{ name = string.format("case_%d_%s_fineness_%g_first_break_m_per_s", n, mode, f),
                  value = run.figures[string.format("case_%d_first_break_%s_m_per_s", n, mode)], unit = "m/s" }
          if n == 1 and mode == "hold" then figure{ name = string.format("tets_fineness_%g", f), value = run.figures.tets } end
        end
      end
    end
  end
end

local error_of_energy, steps = 0, 0
for _, run in pairs(found) do
  error_of_energy = math.max(error_of_energy, run.figures.energy_balance_error or 0)
  steps = steps + (run.figures.steps or 0)
end
figure{ name = "energy_balance_error", value = error_of_energy, reference = 0, kind = "formula", source = "energy is conserved",
        tolerance_absolute = 0.01 }
figure{ name = "steps", value = steps, source = "of all runs" }
figure{ name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
