//! Which missions make samples, by the route that they drive.

/// The name by which missions on no route are chosen.
pub const NO_ROUTE: &str = "none";

/// Missions by route: that of most of their seconds.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum RouteChoice {
    /// Every mission.
    #[default]
    All,
    /// Those on one of these routes.
    Only(Vec<String>),
    /// All but those on one of these routes.
    Without(Vec<String>),
}

impl RouteChoice {
    /// Whether a mission on a route, or on none, makes samples.
    #[must_use]
    pub fn takes(&self, route: Option<&str>) -> bool {
        let named = |routes: &[String]| routes.iter().any(|r| r == route.unwrap_or(NO_ROUTE));
        match self {
            Self::All => true,
            Self::Only(routes) => named(routes),
            Self::Without(routes) => !named(routes),
        }
    }
}
