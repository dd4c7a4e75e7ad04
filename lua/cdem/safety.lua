-- cdem.factor_of_safety: strength reduction by bisection. Trials run one after another, each on all threads of the run,
-- because the next trial depends on the last verdict. The steps of a trial share the cores, with the same bits for
-- every number of threads. So the result does not depend on the machine.
local cdem = ...

local checked = cdem.factor_of_safety -- its arguments, tried

local function text(factor) return string.format("F = %.4g", factor) end

local function length_of(v) return math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2) end

local moves = 0.2 -- part of the largest displacement: blocks that have moved as far fail
local far = 0.02 -- part of the size of what moved: what went further may stand on what it met there

-- What fails: cdem.Mechanism. nil where nothing has moved.
local function mechanism_of(model)
  local blocks, most, all = model:blocks(), 0, 0
  for _, block in ipairs(blocks) do
    block.moved = length_of(block.displacement)
    most, all = math.max(most, block.moved), all + block.volume
  end
  if most == 0 then return nil end
  table.sort(blocks, function(a, b) return a.moved > b.moved or (a.moved == b.moved and a.id < b.id) end)
  local m = { blocks = {}, volume = 0, largest = 0, centroid = {0, 0, 0}, displacement = {0, 0, 0},
              min = {math.huge, math.huge, math.huge}, max = {-math.huge, -math.huge, -math.huge} }
  for _, block in ipairs(blocks) do
    if block.moved < moves * most then break end
    m.blocks[#m.blocks + 1] = block.id
    m.volume, m.largest = m.volume + block.volume, math.max(m.largest, block.volume)
    for i = 1, 3 do
      m.centroid[i] = m.centroid[i] + block.volume * block.centroid[i]
      m.displacement[i] = m.displacement[i] + block.volume * block.displacement[i]
      m.min[i], m.max[i] = math.min(m.min[i], block.centroid[i]), math.max(m.max[i], block.centroid[i])
    end
  end
  for i = 1, 3 do
    m.centroid[i], m.displacement[i] = m.centroid[i] / m.volume, m.displacement[i] / m.volume
  end
  m.share = m.volume / all
  return m
end

local function place(v) return string.format("(%.4g, %.4g, %.4g)", v[1], v[2], v[3]) end

local function counted(blocks) return blocks == 1 and "1 block" or blocks .. " blocks" end

local function described(m)
  local moved = length_of(m.displacement)
  local direction = {}
  for i = 1, 3 do direction[i] = moved > 0 and m.displacement[i] / moved or 0 end
  return string.format("%s, %.3g m3 together (%.2g %% of the model), the largest %.3g m3, about %s, moving along "
                       .. "(%.2f, %.2f, %.2f)",
                       counted(#m.blocks), m.volume, 100 * m.share, m.largest, place(m.centroid), table.unpack(direction))
end

local function tell_of_way(factor, m)
  local moved, size = m and length_of(m.displacement) or 0, m and m.volume ^ (1 / 3) or 1
  if moved > far * size then
    cdem.log(string.format("warning: %s is stable, but only after a way of %.3g m, %.2g %% of the size of what moved (%s): it "
                           .. "may stand on what it met there, and a smaller factor may fail. Look at it, and search below: "
                           .. "upper = %.4g", text(factor), moved, 100 * moved / size, counted(#m.blocks), factor))
  end
end

local function remove(model, m)
  local gone = {}
  for _, id in ipairs(m.blocks) do gone[id] = true end
  local places = {}
  for _, block in ipairs(model:blocks()) do
    if gone[block.id] then places[place(block.centroid)] = true end
  end
  model:remove{ on = function(x, y, z) return places[place{x, y, z}] == true end }
end

-- How the picture looks at the model: across a section; at a body, from the side that what fails moves to.
local function seen_from(model, m)
  local box = model:box()
  local size, middle = {}, {}
  for i = 1, 3 do
    size[i], middle[i] = box.max[i] - box.min[i], 0.5 * (box.max[i] + box.min[i])
  end
  for i, view in ipairs{ "right", "front", "front" } do
    if size[i] < 0.3 * math.min(size[i % 3 + 1], size[(i + 1) % 3 + 1]) then return { view = view } end
  end
  local x, y = m.displacement[1], m.displacement[2]
  local level = math.sqrt(x ^ 2 + y ^ 2)
  if level < 0.2 * length_of(m.displacement) then return { view = "iso", up = "z" } end
  local aside, raised, distance = math.rad(30), math.rad(25), 2.1 * length_of(size)
  x, y = x / level, y / level
  x, y = x * math.cos(aside) - y * math.sin(aside), x * math.sin(aside) + y * math.cos(aside)
  return { camera = { focal_point = middle, up = {0, 0, 1},
                      position = { middle[1] + distance * math.cos(raised) * x, middle[2] + distance * math.cos(raised) * y,
                                   middle[3] + distance * math.sin(raised) } } }
end

-- The displacement of the failing side, drawn a twentieth of the model large.
local function draw(model, file, factor, mechanism)
  local moved, size = model:max("displacement.magnitude"), 0
  local box = model:box()
  for i = 1, 3 do size = math.max(size, box.max[i] - box.min[i]) end
  local picture = mechanism and seen_from(model, mechanism) or { up = "z" }
  picture.file, picture.colour, picture.broken_bonds, picture.size = file, "displacement.magnitude", false, {1600, 0}
  picture.deformation = moved > 0 and tonumber(string.format("%.2g", 0.05 * size / moved)) or 0
  picture.title = "Mechanism, " .. text(factor)
  model:picture(picture)
end

function cdem.factor_of_safety(options)
  local o = checked(options)
  local trials, sides = {}, {}

  -- Is the model stable with its strengths divided by the factor? nil in a check, which solves nothing.
  local function try(factor)
    local model = o.model and o.model:copy() or o.builder()
    model:reduce_strength{ factor = factor, reduce = o.reduce }
    model:reset_displacement()
    local r, mechanism
    local left_out, volume = 0, 0
    repeat
      r = model:relax{ residual = o.residual, max_steps = o.max_steps, trial = text(factor) }
      if r.steps == 0 then
        sides = { stable = model, failing = model }
        return nil
      end
      mechanism = r.verdict ~= "stable" and mechanism_of(model)
      local small = r.verdict == "failing" and mechanism and mechanism.volume < o.smallest
      if small then
        left_out, volume = left_out + #mechanism.blocks, volume + mechanism.volume
        remove(model, mechanism)
        model:reset_displacement()
      end
    until not small
    if left_out > 0 then
      cdem.log(string.format("%s: %s of %.3g m3 fail in mechanisms below smallest = %.3g m3; the trial went on without "
                             .. "them", text(factor), counted(left_out), volume, o.smallest))
    end
    if r.verdict ~= "stable" then
      sides.mechanism, sides.left_out = mechanism or nil, left_out
    else
      tell_of_way(factor, mechanism_of(model))
    end
    trials[#trials + 1] = { factor = factor, verdict = r.verdict, steps = r.steps, residual = r.residual }
    sides[r.verdict == "stable" and "stable" or "failing"] = model
    return r.verdict == "stable"
  end

  local lower, upper = o.lower, o.upper
  local stands = try(lower)
  if stands == nil then -- a check
    if o.picture then draw(sides.failing, o.picture, upper) end
    return { factor = lower, lower = lower, upper = upper, stable = sides.stable, failing = sides.failing, trials = {},
             mechanism = { blocks = {}, volume = 0, largest = 0, share = 0, centroid = {0, 0, 0}, min = {0, 0, 0},
                           max = {0, 0, 0}, displacement = {0, 0, 0} },
             left_out = 0 }
  end
  if not stands then
    if o.picture then draw(sides.failing, o.picture, lower, sides.mechanism) end
    if sides.mechanism then cdem.log(text(lower) .. ": what fails: " .. described(sides.mechanism)) end
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
  local mechanism = sides.mechanism
  if mechanism then
    cdem.log(text(upper) .. ": what fails: " .. described(mechanism))
    cdem.report{ { name = o.figure .. "_volume", value = mechanism.volume, unit = "m3" },
                 { name = o.figure .. "_blocks", value = #mechanism.blocks } }
    if mechanism.share < 0.01 then
      cdem.log(string.format("the factor is that of %.2g %% of the model; smallest = %.2g leaves such falls out",
                             100 * mechanism.share, 2 * mechanism.volume))
    end
  end
  if o.picture then draw(sides.failing, o.picture, upper, mechanism) end
  return { factor = factor, lower = lower, upper = upper, stable = sides.stable, failing = sides.failing,
           mechanism = mechanism, left_out = sides.left_out or 0, trials = trials }
end
