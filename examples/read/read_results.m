% Reads what orchard writes with MATLAB or Octave: an axis, a tree and reports.
%   read_results(FOLDER, MODEL), after
%   orchard medial MODEL.obj -o FOLDER --report --export csv
%   orchard build MODEL.obj -o FOLDER --export csv
function read_results(folder, model)
  file = @(ending) fullfile(folder, [model ending]);
  balls = rows_of(file('-axis-balls.csv'));
  contacts = rows_of(file('-axis-contacts.csv'));
  triangles = rows_of(file('-axis-triangles.csv')) + 1;  % indices count from 0
  owner = contacts(:, 1) + 1;
  distance = sqrt(sum((contacts(:, 2:4) - balls(owner, 1:3)).^2, 2));
  fprintf('%d balls, radii %.3g to %.3g, %d triangles\n', size(balls, 1), min(balls(:, 4)), max(balls(:, 4)), size(triangles, 1));
  fprintf('contacts are off the radius by %.2g at most\n', max(abs(distance - balls(owner, 4))));

  nodes = rows_of(file('-nodes.csv'));  % x, y, z, radius, inaccuracy, level, parent
  below = sum(nodes(:, 7) == 0);
  fprintf('%d spheres on %d levels, the root of radius %.3g, %d below it\n', size(nodes, 1), max(nodes(:, 6)) + 1, nodes(1, 4), below);

  axis_report = jsondecode(fileread(file('-medial.json')));
  tree_report = jsondecode(fileread(file('.json')));
  fprintf('the axis is within %.3g %% of the diagonal\n', axis_report.quality.hausdorff_max);
  fprintf('the deepest level has inaccuracy %.3g in the mean\n', tree_report.levels(end).mean_inaccuracy);
end

% The numbers of a .csv file, whose last line is a comment.
function rows = rows_of(file)
  lines = strsplit(fileread(file), char(10));
  lines = lines(~cellfun(@isempty, lines) & ~strncmp(lines, '#', 1));
  columns = numel(strsplit(lines{1}, ','));
  rows = reshape(sscanf(strjoin(lines(2:end), ','), '%f,'), columns, [])';
end
