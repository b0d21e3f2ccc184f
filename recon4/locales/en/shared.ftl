### What all pages have in common; each page has these texts together with its own.

## Words of many pages

cancel = Cancel
close = Close
name = Name
language = Language

## Bar at the top

head-where = Where you are
head-projects = Projects
head-pages = Pages of the project
head-project = Project
head-map = Map
head-review = Review
head-slices = Slices
head-report = Report
head-live = Live
head-rigs = Rigs
head-storage = Storage
head-api = API
head-help = Help
head-people = People
head-account = Account of { $name }, { $role }
head-sign-out = Sign out
head-lost = Connection lost, trying again

## Roles

role-nobody = nobody
role-guest = guest
role-viewer = viewer
role-operator = operator
role-reviewer = reviewer
role-admin = admin
