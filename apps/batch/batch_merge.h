#pragma once
#include "command_line/commands.h"

namespace orchard::apps {

// `orchard batch merge FOLDER.. -o PLACE`: batch.jsonl, batch.csv and batch-summary.json, which depend on the rows
// alone; batch-costs.csv and batch.svg, which hold times. Throws InputError if shards are missing.
void merge_batches(const BatchCommand& command);

}  // namespace orchard::apps
