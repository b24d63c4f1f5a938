% Reads what orchard writes with MATLAB or Octave: an axis, a tree and reports.
%   read_results(FOLDER, MODEL), after
%   orchard medial MODEL.obj -o FOLDER --report --export csv
%   orchard build MODEL.obj -o FOLDER --export csv
function read_results(folder, model)
  table = @(ending) dlmread(fullfile(folder, [model ending '.csv']), ',', 1, 0);
  balls = table('-axis-balls'); contacts = table('-axis-contacts'); triangles = table('-axis-triangles') + 1;
  owner = contacts(:, 1) + 1;
  distance = sqrt(sum((contacts(:, 2:4) - balls(owner, 1:3)).^2, 2));
  fprintf('%d balls, radii %.3g to %.3g, %d triangles\n', size(balls, 1), min(balls(:, 4)), max(balls(:, 4)), size(triangles, 1));
  fprintf('contacts are off the radius by %.2g at most\n', max(abs(distance - balls(owner, 4))));

  nodes = table('-nodes');  % x, y, z, radius, inaccuracy, level, parent
  children = sum(nodes(:, 7) == 0);
  fprintf('%d spheres on %d levels, the root of radius %.3g, %d below it\n', size(nodes, 1), max(nodes(:, 6)) + 1, nodes(1, 4), children);

  report = @(ending) jsondecode(fileread(fullfile(folder, [model ending '.json'])));
  axis_report = report('-medial'); tree_report = report('');
  fprintf('the axis is within %.3g %% of the diagonal\n', axis_report.quality.hausdorff_max);
  fprintf('the deepest level has inaccuracy %.3g in the mean\n', tree_report.levels(end).mean_inaccuracy);
end
