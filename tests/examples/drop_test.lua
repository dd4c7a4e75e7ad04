-- Drop tests, shortened: a cube that falls flat presses on a rigid floor with rho c v A and leaves it; a brittle cube breaks
-- between two heights, the same ones at any size: a brittle law has no length. A unit overturns with the velocity of the
-- formula, and one that swings against a block breaks as one that falls flat.
local cdem = require "cdem"
local expect = require "expect"

local flat = cdem.sweep{ script = "../../examples/drop_test/flat.lua", set = { { divisions = 6 } } }[1]
if flat.exit_code ~= 0 then error("flat.lua ended with exit code " .. flat.exit_code) end
expect.near(flat.figures, "force_over_rho_c_v_a", 1, 0.03)
expect.between(flat.figures, "peak_over_rho_c_v_a", 1, 1.1)
expect.between(flat.figures, "energy_balance_error", 0, 0.01)

local function changed(settings, changes)
  local set = {}
  for name, value in pairs(settings) do set[name] = value end
  for name, value in pairs(changes) do set[name] = value end
  return set
end
local function run(script, sets)
  local results = cdem.sweep{ script = script, set = sets }
  for _, result in ipairs(results) do
    if result.exit_code ~= 0 then error(script .. " ended with exit code " .. result.exit_code) end
  end
  return results
end

local case = "../../examples/drop_test/case.lua"
local brittle = { fineness = 2.0, low = 0.006, pictures = false, bisections = 6, fracture_energy = 0, floor = "rigid",
                  test = "pendulum" }
local coarse = { fineness = 2.0, low = 0.4, pictures = false, bisections = 2 }
local tests = run(case, { changed(brittle, { mass = 2000.0 }), changed(brittle, { mass = 16000.0 }),
                          changed(brittle, { mass = 50000.0 }), changed(brittle, { test = "drop", mass = 2000.0 }),
                          changed(coarse, { test = "overturning", shape = "dolos", low = 0.02 }),
                          changed(coarse, { test = "pendulum", film = 2, after = 0.02 }), coarse,
                          changed(coarse, { test = "pendulum", target = "unit", bisections = 0 }),
                          changed(coarse, { contact_stiffness = 0.05, bisections = 0 }),
                          changed(brittle, { test = "drop", mass = 50000.0 }) })
for _, one in ipairs(tests) do
  expect.between(one.figures, "whole_at_m", 0, 10)
  expect.between(one.figures, "energy_balance_error", 0, 0.02)
end
-- A swing has no weight in it, which would be a length: the same springs break at any size. In a fall heights scatter by a sixth.
for size = 2, 3 do expect.near(tests[size].figures, "critical_height_m", tests[1].figures.critical_height_m, 1e-9) end
expect.between(tests[10].figures, "critical_height_m", 0.8 * tests[4].figures.critical_height_m,
               1.25 * tests[4].figures.critical_height_m)

-- The dolos breaks long before it could fall from balance. Its tilt is that of the height, by geometry.
local dolos = tests[5].figures
expect.between(dolos, "kinetic_energy_error", 0, 0.1)
expect.between(dolos, "critical_height_m", 0, 0.2 * dolos.height_from_balance_m)
expect.between(dolos, "critical_tilt_deg", 0, 10)

-- Flat against a block of the floor's kind: the same impact but for the meshes and the weight.
expect.near(tests[6].figures, "critical_height_m", tests[7].figures.critical_height_m, 0.5)
-- A contact a twentieth as stiff as the tets cushions the fall.
expect.between(tests[9].figures, "critical_height_m", 1.5 * tests[7].figures.critical_height_m, 10)

local overturns = run("../../examples/drop_test/overturn.lua", { { share = 0.7 }, { shape = "dolos", fineness = 3.0 } })
for _, one in ipairs(overturns) do expect.near(one.figures, "velocity_over_formula", 1, 0.02) end
expect.done()
