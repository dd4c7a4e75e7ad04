-- What drives the damage under waves, and what breaks units: case.lua many times, coarse and with short groups.
--
--   ./cdem run examples/armour_waves/study.lua                      # C_D, C_A, friction, period, one at a time; five layers
--   ./cdem run examples/armour_waves/study.lua --set part=breakable # share broken over mass, strength and wave height
local cdem = require "cdem"
local least_squares = require "least_squares"

local part = cdem.parameter{ name = "part", default = "rigid", choices = {"rigid", "breakable"} }
local vary = cdem.parameter{ name = "vary", default = {"drag", "added_mass", "friction_angle", "period", "seed"},
                             doc = "of rigid units, one at a time" }
local units = cdem.parameter{ name = "units", default = 8, range = {8, 200}, doc = "in four columns, the lowest row held" }
local fineness = cdem.parameter{ name = "fineness", default = 2.0, range = {2, 20}, doc = "of case.lua" }
local modulus = cdem.parameter{ name = "youngs_modulus", default = 3e9, range = {1e8, 1e12}, unit = "Pa",
                                doc = "a tenth of concrete's: steps are three times as long" }
local first = cdem.parameter{ name = "first_ns", default = 3.5, range = {0.1, 10}, doc = "of rigid units" }
local groups = cdem.parameter{ name = "groups", default = 5, range = {1, 50}, doc = "of rigid units, at most" }
local layers = cdem.parameter{ name = "layers", default = 5, range = {2, 100}, doc = "of rigid units: seeds 1, 2, ..." }
local seeds = cdem.parameter{ name = "seeds", default = 2, range = {1, 100}, doc = "of breakable units: seeds 1, 2, ..." }
local strengths = cdem.parameter{ name = "strengths", default = {0.7e6, 1e6, 1.4e6}, range = {1e3, 1e9}, unit = "Pa" }
local masses = cdem.parameter{ name = "masses", default = {5000.0, 8000.0, 12000.0}, range = {100, 1e5}, unit = "kg" }
local heights = cdem.parameter{ name = "heights", default = {6.0, 7.5}, range = {0.1, 100}, unit = "m", doc = "of the wave" }
local toughness = cdem.parameter{ name = "fracture_energy", default = 0.0, range = {0, 1e6}, unit = "J/m2", doc = "0: brittle" }
local quiet = cdem.parameter{ name = "rigid_for", default = 4.4, range = {0, 1000}, unit = "s", doc = "of case.lua" }
local longest = cdem.parameter{ name = "time", default = 1e6, range = {0.01, 1e6}, unit = "s", doc = "of waves, at most" }
local jobs = cdem.parameter{ name = "jobs", default = 1, range = {1, 64}, doc = "runs side by side" }

local common = { units = units, fineness = fineness, youngs_modulus = modulus, rest = 0, time = longest, pictures = false }
local function with(changes)
  local set = {}
  for _, from in ipairs{ common, changes } do
    for name, value in pairs(from) do set[name] = value end
  end
  return set
end
local figures = {}
local function tell(name, value, unit) figures[#figures + 1] = { name = name, value = value, unit = unit } end
local function mean(list)
  local sum, square = 0, 0
  for _, x in ipairs(list) do sum = sum + x end
  for _, x in ipairs(list) do square = square + (x - sum / #list) ^ 2 end
  return #list > 0 and sum / #list or nil, #list > 1 and math.sqrt(square / (#list - 1)) or nil
end
local function worst(results)
  for _, name in ipairs{ "energy_balance_error", "deepest_contact_over_height" } do
    local most = 0
    for _, run in ipairs(results) do most = math.max(most, run.figures and run.figures[name] or 0) end
    tell("worst_" .. name, most)
  end
end

if part == "rigid" then
  local tried = { drag = {0.5, 2.0}, added_mass = {0.0, 1.0}, friction_angle = {25.0, 45.0}, period = {7.0, 10.0}, seed = {} }
  for seed = 2, layers do tried.seed[seed - 1] = seed end -- the base has seed 1
  local runs = { { "base" } }
  for _, name in ipairs(vary) do
    if not tried[name] then error("vary: it knows drag, added_mass, friction_angle, period and seed, not " .. name) end
    for _, value in ipairs(tried[name]) do
      runs[#runs + 1] = { string.format("%s_%g", name, value), [name] = value }
    end
  end
  local sets, told = {}, { "first_unit_out_ns", "damage_ns", "mean_movement_over_dn_ns_4" }
  for i, run in ipairs(runs) do
    sets[i] = with{ first_ns = first, groups = groups, ends_at = 0.5 }
    for name, value in pairs(run) do
      if name ~= 1 then sets[i][name] = value end
    end
  end
  local results = cdem.sweep{ script = "case.lua", set = sets, jobs = jobs }
  for i, result in ipairs(results) do
    local values = result.figures or {}
    for _, name in ipairs(told) do tell(runs[i][1] .. "_" .. name, values[name]) end
  end
  for _, name in ipairs{ "first_unit_out_ns", "damage_ns" } do
    local list = {}
    for i, result in ipairs(results) do
      if i == 1 or runs[i].seed then list[#list + 1] = result.figures and result.figures[name] end
    end
    local value, spread = mean(list)
    tell(name .. "_mean", value)
    tell(name .. "_standard_deviation", spread)
    tell(name .. "_layers", #list) -- that reached it
  end
  worst(results)
else
  local delta, sets, cells = 2400 / 1025 - 1, {}, {}
  for _, mass in ipairs(masses) do
    local Dn, scale = (mass / 2400) ^ (1 / 3), (mass / 5000) ^ (1 / 6)
    for _, tension in ipairs(strengths) do
      for _, height in ipairs(heights) do
        cells[#cells + 1] = { mass = mass, tension = tension, height = height }
        for seed = 1, seeds do -- one sea and one period for all masses; case.lua scales times by Froude's law
          sets[#sets + 1] = with{ breakable = true, fracture_energy = toughness, tensile_strength = tension, mass = mass,
                                  seed = seed, groups = 1, first_ns = height / delta / Dn, highest_ns = 9.5 / delta / Dn,
                                  period = 8 / scale, rigid_for = quiet / scale }
        end
      end
    end
  end
  local results = cdem.sweep{ script = "case.lua", set = sets, jobs = jobs }
  local columns = { mass = {}, tension = {}, height = {}, units = {}, faces = {} }
  for i, cell in ipairs(cells) do
    local shares, faces = {}, {}
    for seed = 1, seeds do
      local values = results[(i - 1) * seeds + seed].figures or {}
      shares[#shares + 1] = values.broken_share and values.broken_share * units / (units - 4) -- of those that are free
      faces[#faces + 1] = values.faces_broken
    end
    cell.units, cell.faces = mean(shares), mean(faces)
    for name, list in pairs(columns) do list[i] = cell[name] or 0 / 0 end -- nan: its runs failed
    local at = string.format("%g_t_%g_mpa_%g_m", cell.mass / 1000, cell.tension / 1e6, cell.height)
    tell("broken_share_" .. at, cell.units)
    tell("faces_broken_" .. at, cell.faces)
  end
  cdem.write_csv{ file = "breakable.csv", columns = {
    { name = "mass_kg", values = columns.mass }, { name = "tensile_strength_pa", values = columns.tension },
    { name = "wave_height_m", values = columns.height }, { name = "broken_share", values = columns.units },
    { name = "faces_broken", values = columns.faces } } }
  for _, what in ipairs{ "units", "faces" } do
    local rows, y = {}, {}
    for _, cell in ipairs(cells) do
      if cell[what] and cell[what] > 0 then
        rows[#rows + 1] = { 1, math.log(cell.mass / 5000), math.log(cell.tension / 3e6), math.log(cell.height / 6) }
        y[#y + 1] = math.log(cell[what])
      end
    end
    tell(what .. "_cells_in_the_fit", #rows)
    local exponents, errors
    if #rows > 4 then exponents, errors = least_squares(rows, y) end
    for j, name in ipairs{ "mass", "strength", "height" } do
      tell(what .. "_exponent_of_" .. name, exponents and exponents[j + 1])
      tell(what .. "_exponent_of_" .. name .. "_standard_error", errors and errors[j + 1])
    end
  end
  worst(results)
end
table.sort(figures, function(a, b) return a.name < b.name end)
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
