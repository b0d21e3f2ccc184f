### The page on which loop closures are decided about and the map is approved.


## Page

title = Review · recon4
pairs-to-decide = Pairs to decide about
two-places = The two places
figures-and-effects = Figures and effects
journal = Journal
title-of = Review of { $project } · recon4
reading-points = Reading points…
no-points = No points to show
not-registered-yet = This pair is not registered: align it and refine it first
sorting = Sorting the loop closures…
no-pairs = This walk has no pair to decide about
no-pairs-listed = No pair matches the filters of the list
nothing-yet = Nothing to review until loop closures have been searched and verified
press-j = Next (J) shows the first pair
nothing-to-review = Nothing to review

## Verdicts

mark-accepted = Accepted
mark-rejected = Rejected
mark-unverified = Unverified
did-accept = accepted{ $pair }
did-reject = rejected{ $pair }
did-restore = restored the automatic decision on{ $pair }
did-replace = registered again{ $pair }
did-add = added{ $pair }
did-undo = undid the last decision{ $pair }
did-redo = made the last undone decision again{ $pair }
did-approve = approved the map{ $pair }
did-acknowledge = acknowledged a finding{ $pair }
did-control = changed the control points{ $pair }
did-classify = corrected classes of points{ $pair }
did-withdraw = withdrew a correction of classes{ $pair }
did-assign = assigned{ $pair }
did-comment = commented on{ $pair }
did-skip = left for later{ $pair }
did-second = asked for a second opinion on{ $pair }
did-waive = withdrew the question for a second opinion on{ $pair }
did-pair = { " " }multiframes { $i } and { $j }

## Reasons of rejections, and who judged

reason-overlap = overlap < t_o
reason-error = error > limit
reason-not-converged = not converged
reason-few-matches = too few segments match
reason-degenerate = degenerate
reason-seen-through = free space contradicts it
reason-unconfirmed = neighboring places do not confirm it
reason-ambiguous = ambiguous: places look alike
reason-verification = verification median > limit
reason-robust = outlier in the robust solution
reason-operator = operator
judge-odometry = odometry
judge-search = search
judge-free-space = free space
judge-neighboring-places = neighboring places
judge-verification = verification
judge-robust-solve = robust solve
judge-gnss = GNSS
judge-person = person
judge-people = people
judge-program = program
verdict-accepted = accepted
verdict-rejected = rejected
verdict-unverified = unverified
verdict-left-to-the-program = left to the program
edge-loop = loop
edge-neighbor = neighbor
edge-manual = manual
edge-odometry = odometry

## Keys

do-next = Next pair
do-previous = Previous pair
do-accept = Accept, once the points of this pair are drawn
do-reject = Reject, once the points of this pair are drawn
do-skip = Skip for later
key-restore = U or Backspace
do-restore = Restore the automatic decision
key-undo = Ctrl Z
do-undo = Undo
key-redo = Ctrl Y
do-redo = Redo
key-move = Arrows
do-move = Move the second place by 5 cm (Shift: 1 cm, Alt: 50 cm)
key-turn = , and .
do-turn = Turn it by 1° (Shift: 0.1°, Alt: 10°)
key-lift = Page up, Page down
do-lift = Lift it, lower it
do-pick = Pick the same three points in both places
key-refine = Enter
do-refine = Refine from here; once more: create the edge
key-drop = Escape
do-drop = Drop the new alignment
do-add = Add a loop closure between any two multiframes
do-view = Next view: above, side, free, cut
do-compare = Compare: odometry, graph, aligned
do-difference = Difference: in color only what one place has alone
key-cut = { "[" } and ]
do-cut = Move the cut
key-zoom = + and −
do-zoom = Zoom
do-reason = Write a reason
do-help = This list
key-held = A key held down
do-held = Acts once, except for moving, turning, cut and zoom. After a decision A and R act again once another pair is drawn

## A pair

created-by-person = Created by a person
accepted-automatically = Accepted automatically
path-discrepancy-over = path discrepancy { $found } > { $limit }
rejected-automatically = Rejected automatically: { $reason }

## Map and approval

job-runs-mark = ▶ A job waits or runs
no-map-mark = ◌ There is no finished map yet
not-in-map-mark = ◌ The last decisions are not in the map yet
made-with-decisions = ✓ The map was made with these decisions
made-without-decisions = ✓ The map was made without decisions of people
job-runs = A job waits or runs
no-map = There is no finished map yet
not-in-map = The last decisions are not in the map
map-is-approved = This map is approved
second-opinion-missing = { $others ->
    [0] { $who } asked for a second opinion on multiframes { $i } and { $j }, and two people do not agree yet: decide, or withdraw the question
    [one] { $who } asked for a second opinion on multiframes { $i } and { $j } and { $others } other pair, and two people do not agree yet: decide, or withdraw the question
   *[other] { $who } asked for a second opinion on multiframes { $i } and { $j } and { $others } other pairs, and two people do not agree yet: decide, or withdraw the question
}
permission-missing = Requires the permission to { $permission }, which you do not have
may-review = review
may-process = process

## Dialogs

first-multiframe = First multiframe (blue)
second-multiframe = Second multiframe (orange)
keys = Keys
add-loop-closure = Add a loop closure
at-multiframe = { $time }, multiframe { $frame }
same-multiframe = Both are the same multiframe
walk-from-above = The walk from above
look-at-pair = Look at this pair
signed-is = Your name, the time, the verdict, the figures and the hashes of all results are signed. A version is kept that no later run or decision changes.
what-is-approved = What is approved
reason-hint = Needed in spite of the findings, at least { $characters } characters. It stands in the report and in every exported file
reason-required = Reason (required)
remark = Remark
approve-map-title = Approve map
sign-anyway = { $count ->
    [one] { $count } accepted loop closure does not fit the graph; sign anyway
   *[other] { $count } accepted loop closures do not fit the graph; sign anyway
}
signing = Signing…
sign = Sign

## Verdicts on a pair

measure-overlap = overlap
measure-error-m = error
measure-match-ratio = matches
measure-degeneracy = degeneracy
measure-seen-through = seen through
measure-confirmed-nodes = nodes that confirm it
measure-contradicted-nodes = nodes that contradict it
measure-verification-m = path discrepancy
measure-chi2 = squared residual
with-limit = { $figure }, limit { $limit }
no-alternative-path = no alternative path

## Panels

no-pair = No pair selected
influence = Influence on the map
influence-hint = How far the map moves if this edge is rejected instead of accepted, or the reverse
overlap = Overlap
overlap-hint = Part of the view volume of the first place that the second one sees too
registration-error = Registration error
registration-error-hint = Mean distance of the matched features
degeneracy = Degeneracy
degeneracy-scale = 0 unobservable, 0.33 isotropic
degeneracy-hint = Smallest eigenvalue of the normalized information; near 0 the places can slide
path-discrepancy = Path discrepancy
path-discrepancy-hint = Distance between this edge and the other paths through the graph between its ends
chi-square = Chi-square contribution
chi-square-hint = Squared residual of this edge, weighted by its information
residual-to-graph = Residual to the graph
residual-hint = Difference between this edge and the relative pose in the optimized graph
decided-by = Decided by
limit-is = limit { $limit }
median-of-paths = median of { $paths } alternative paths
not-in-map-yet = (not in the map yet)
history-of-verdict = History of the verdict ({ $count })
alternative-paths = Alternative paths ({ $count })
and-more = and { $count } more
effect = Effect
effect-solving = Effect (solving…)
solving = Solving the graph…
no-decisions = No decisions yet
multiframes = multiframes { $i } and { $j }
conflict = residual { $length }, { $angle }, by { $who }
move = { $length } at multiframe { $frame } ({ $time })
chi-last = Chi-square, last decision
edges-in-graph = Edges in the graph
chi-all = Chi-square, all decisions
largest-move = Largest move, all decisions
does-not-fit = ✕ Accepted, but does not fit the graph
without-effect = Without effect: not in this graph, or not registered
registered-again = Registered again since the decision
rejected-as-consequence = Rejected automatically as a consequence
accepted-as-consequence = Accepted automatically as a consequence
largest-moves = Largest moves of the last decision
map = Map
rebuild-map = Rebuild map
approve-map = Approve map…
approval-obstacle = Approval: { $obstacle }
meanwhile = Meanwhile { $who } { $did }
meanwhile-after = { $others ->
    [one] Meanwhile { $who } { $did }, after { $others } other entry of the journal
   *[other] Meanwhile { $who } { $did }, after { $others } other entries of the journal
}

## Queue

queue-loops = Loop closures
queue-doubt = Rejected or unverified
queue-kept = Accepted
queue-open = Decided automatically
queue-decided = Decided by people
queue-mine = Assigned to me
queue-second = Waiting for a second opinion
queue-later = Skipped for later
queue-all = All registered pairs
queue-apart = Not registered
loops = Loops
which-pairs = Which pairs
reason-of-rejection = Reason of the rejection
any-reason = Any reason
queue-count = { $at } of { $count } · { $decided } decided by people
none = None
by-person = by { $who }

## Actions and hints

refining = Refining…
create-edge = Create edge
refine = Refine
hint-decided = Decided. Next (J) shows the next pair, Undo (U or Ctrl Z) reverts the decision
hint-moved = Moved by hand. Enter refines from here
hint-not-registered = Not registered: refine it (move it first if it is far off), then create the edge
pair-title = Multiframes { $i } and { $j }
hint-not-converged = Registration did not converge: move it nearer and refine again
hint-refined = Refined, { $length } and { $angle } from the graph. Enter creates the edge
hint-refined-rejected = Refined, { $length } and { $angle } from the graph. It would be rejected automatically: { $reason }
previous = Previous
reject = Reject
accept = Accept
next = Next
restore = Restore
pick-points = Pick points
undo = Undo
redo = Redo
add-loop = Add loop
reason-optional = Reason (optional)
reason = Reason
go-on = Go on to the next pair after a decision

## Team

team = Team
withdraw-question = Withdraw the question
ask-second = Ask for a second opinion
left-for-later = { $who } left it for later
skip-for-later = Skip for later (S)
assigned-to = Assigned to
nobody = Nobody
comment = Comment
do-comment = Comment
assigned-to-person = Assigned to { $who }
list-and = { $all } and { $last }
agree = ✓ { $names } agree: { $verdict }
one-said = { $who } { $verdict }
one-decided = { $who } { $verdict } it
asked-second = ◌ { $who } { $verdict } it; { $asking } asked for a second opinion
asked-two = ◌ { $asking } asked for two opinions
later = later
second-opinion = second opinion
disagree = ▲ disagree
nobody-else = Nobody else is looking now
at-this-pair = { $who } (at this pair)
at-pair = { $who } (multiframes { $i } and { $j })
now-here = Now here: { $people }
