-- Units in waves, shortened: two seconds of low waves on eight units. Nothing leaves its place, the water runs up the slope,
-- nothing passes through the ground, and the energy is kept. Units of ten times the usual strength stay whole in them, be they
-- tough or brittle. Another seed is another layer, softer concrete has deeper contacts. The study tells both layers apart. Its
-- fit finds the exponents of a law that is exact.
local cdem = require "cdem"
local expect = require "expect"

local function short(changes)
  local set = { units = 8, groups = 1, time = 0.3, pictures = false, fineness = 2 }
  for name, value in pairs(changes) do set[name] = value end
  return set
end
local function swept(script, set)
  local runs = cdem.sweep{ script = "../../examples/armour_waves/" .. script, set = set }
  for _, run in ipairs(runs) do
    if run.exit_code ~= 0 then error("the example ended with exit code " .. run.exit_code) end
  end
  return runs
end
local low, tough, base, layer, soft, smooth, brittle = table.unpack(swept("case.lua", {
  { units = 8, groups = 1, time = 2.0, pictures = false, fineness = 2 },
  { units = 8, groups = 1, time = 0.3, pictures = false, breakable = true, tensile_strength = 3e7, fracture_energy = 1e4 },
  short{}, short{ seed = 2, film = 0.15 }, short{ youngs_modulus = 3e9 }, short{ friction_angle = 10.0 },
  short{ breakable = true, tensile_strength = 3e7, fracture_energy = 0.0, rigid_for = 0.2 } }))
expect.between(low.figures, "largest_movement_over_dn_ns_2.5", 0, 0.2)
expect.between(low.figures, "run_up", 0.5, 10)
expect.between(low.figures, "deepest_contact_over_height", 0, 0.01)
expect.between(low.figures, "energy_balance_error", 0, 0.01)
expect.between(tough.figures, "broken_share", 0, 0)
expect.between(brittle.figures, "broken_share", 0, 0)
expect.between(brittle.figures, "faces_broken", 0, 0)
local movement = "largest_movement_over_dn_ns_2.5"
for name, other in pairs{ seed = layer, friction = smooth, rigid_for = brittle } do
  if other.figures[movement] == base.figures[movement] then error(name .. " changes nothing") end
end
local deepest = base.figures.deepest_contact_over_height -- contacts of a tenth of the stiffness are three to ten times as deep
expect.between(soft.figures, "deepest_contact_over_height", 2 * deepest, 15 * deepest)
if not io.open("armour_waves/" .. layer.output .. "/wave.ogv") then error("no film") end -- the folder of this run

local study = swept("study.lua", { { vary = {"seed"}, layers = 2, groups = 1, first_ns = 4.0, time = 0.3 },
                                   { part = "breakable", masses = {5000.0}, strengths = {3e7}, heights = {6.0}, seeds = 1,
                                     rigid_for = 0.2, time = 0.3 } })
if study[1].figures["base_mean_movement_over_dn_ns_4"] == study[1].figures["seed_2_mean_movement_over_dn_ns_4"] then
  error("the study has one layer")
end
expect.between(study[1].figures, "first_unit_out_ns_layers", 0, 0)
expect.between(study[2].figures, "broken_share_5_t_30_mpa_6_m", 0, 0)
expect.between(study[2].figures, "faces_broken_5_t_30_mpa_6_m", 0, 0)

package.path = package.path:match("^[^;]*/") .. "../../examples/armour_waves/?.lua;" .. package.path -- from this folder
local least_squares = require "least_squares"
local rows, y = {}, {}
for _, mass in ipairs{ 1, 4 } do
  for _, strength in ipairs{ 1, 2, 3 } do
    rows[#rows + 1] = { 1, math.log(mass), math.log(strength) }
    y[#y + 1] = 0.5 - 0.8 * math.log(mass) - 2.7 * math.log(strength)
  end
end
local exponents, errors = least_squares(rows, y)
for i, exact in ipairs{ 0.5, -0.8, -2.7 } do
  expect.between({ exponent = exponents[i] }, "exponent", exact - 1e-9, exact + 1e-9)
  expect.between({ error = errors[i] }, "error", 0, 1e-9)
end
expect.done()
